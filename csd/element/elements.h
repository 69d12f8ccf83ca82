// SPDX-License-Identifier: Apache-2.0
// All elements of the model: blocks and the material of each body, and the loops over them.
#pragma once
#include <span>
#include <vector>

#include "csd/element/blocks.h"
#include "csd/material/list.h"
#include "csd/state.h"

namespace bw::csd {

struct Elements {
  Blocks blocks;
  std::vector<Materials> materials;  ///< [body]
  Aligned<double> corner_mass;       ///< [block][8][lanes] kg: row sums of rho_0 N_a (VALIDATION A.3)

  double mass(SlotId slot, int corner) const {
    return corner_mass[size_t((slot / lanes * 8 + corner) * lanes + slot % lanes)];
  }

  int body_of(SlotId slot) const;
};

/// Bulk viscosity: on compression sigma_m gains rho h (c1 c_L + c2 h |rate|) rate, h = cube root of the volume.
struct BulkViscosity {
  double linear = 0, quadratic = 0;
  bool on() const { return linear > 0 || quadratic > 0; }
};

/// What the mean stress of the next forces is made of besides U'(v_e/V_e).
struct MeanStress {
  const Field<double, SlotId>* given = nullptr;  ///< Pa, replaces U' (a filtered pressure); null: U'
  BulkViscosity viscosity;
  double dt = 0;  ///< s since State::volume was taken, for the viscosity's rate
};

/// Fills State and the corner masses from the mesh: fields sized, reference volumes, history, lumped masses, x = X, v =
/// 0. InputError naming the element if a reference volume (or its determinant at a point) is not positive.
void start(const Mesh& mesh, Elements& elements, State& s);

/// s.f = internal forces; new history, volume, omega2 and collapsed. Returns the work spent in viscosity since the last
/// call [J].
double internal_force(const Elements& elements, const MeanStress& mean_stress, State& s);

/// Lumped mass of a node [kg]: its share of the elements given, which must ascend, so that it has one value.
double node_mass(const Mesh& mesh, const Elements& elements, std::span<const ElemId> around, NodeId n);

}  // namespace bw::csd
