// SPDX-License-Identifier: Apache-2.0
// Integrals over the open cells of the fluid, kept per block so that a step adds up only what it changed. Sums run in the
// global order of blocks.
#pragma once
#include <array>
#include <vector>

#include "cfd/build.h"

namespace bw::cfd {

struct FluidSums {
  double U[Cons::most] = {};    ///< masses [kg], momentum [kg m/s], energy [J], volumes of materials [m^3], as Cons
  double volume = 0;            ///< m^3, open cells
};

struct SweptSums {
  double mass_lost = 0, mass_made = 0, energy_lost = 0, energy_made = 0;
  Vec3 momentum;  ///< made less lost
  int64_t covered = 0, fresh = 0;
};

class Books {
 public:
  explicit Books(const Model& m) { fit(m); }
  /// The forest has other blocks now: refresh all of them.
  void fit(const Model& m) { per_block_.assign(size_t(m.forest.local_blocks()), {}); }
  void refresh(const Model& m, const std::vector<int>& blocks);
  /// Collective.
  FluidSums sums(const Model& m) const;
  /// All ranks' swept, masses [kg], energies [J] and cells. Collective.
  SweptSums swept_sums(const Comm& comm) const;
  double p_max(const Model& m) const;  ///< Pa
  Booked booked(const Model& m) const;

  Swept swept;                ///< this rank's, since the start
  Vec3 wall_impulse;          ///< N s, momentum that the fluid gave to walls through cut links
  double wall_energy = 0;     ///< J, energy that left through cut links
  double wall_mass = 0;       ///< kg, likewise: the defect of link walls
  Vec3 face_impulse;          ///< N s, sum of -p A dt over the wet faces (absolute pressure)
  double face_work = 0;       ///< J, likewise
  int64_t repeated = 0;         ///< steps that failed and were taken again at half their size
  double seconds_between_levels = 0;  ///< of a thread, at faces between levels
  Vec3 lip_impulse;           ///< N s, kept from the walls by the blending of lips

 private:
  std::vector<FluidSums> per_block_;
};

}  // namespace bw::cfd
