// SPDX-License-Identifier: Apache-2.0
// What elements bear and store, evaluated on demand from positions and history (nothing is committed).
#pragma once
#include "csd/element/elements.h"
#include "csd/element/hex.h"

namespace bw::csd {

/// Means over the current volume, sums over the element.
struct ElementResult {
  Sym3 sigma;                  ///< Pa, mean Cauchy stress, tension positive
  double eqps = 0;             ///< mean over the points
  double eqps_max = 0;         ///< of its points
  double elastic = 0;          ///< J, V U(J_bar) + sum of W_bar
  double plastic = 0;          ///< J, spent since the start
  double heat = 0;             ///< J, the part of it that heats
  double temperature = 0;      ///< K, mean over the points; 0: the material has none
  double temperature_max = 0;  ///< K, of its points
  double collapse = 0;         ///< J, in points that lost most of their volume
};

double von_mises(const Sym3& sigma);

/// sigma_m of the elements as in the last internal_force: null for U'(v/V) of the material.
ElementResult evaluate(const Elements& elements, const State& s, SlotId slot,
                       const Field<double, SlotId>* sigma_m = nullptr);

/// Nodal forces of an element [N] at U'(v/V), without filter and viscosity.
Corners<double> element_force(const Elements& elements, const State& s, SlotId slot);

/// Of all elements; those of rigid bodies' blocks (State::of_rigid) are not looked at.
StoredEnergy stored_energy(const Elements& elements, const State& s);
/// Of a block of this rank at s.x.
StoredEnergy stored_energy(const Elements& elements, const State& s, int block);

/// Whether the body's material heats by plastic work.
bool heats(const Elements& elements, int body);

/// Mean flow stress of an element's points at a rate of eqps [1/s] and their present eqps and temperature [Pa]; 0:
/// nothing flows.
double flow_stress(const Elements& elements, const State& s, SlotId slot, double rate);
/// kg/m^3 of reference volume.
double density(const Elements& elements, SlotId slot);

/// U'(v/V) [Pa] at State::volume, tension positive.
double mean_stress(const Elements& elements, const State& s, SlotId slot);
/// Mises' stress of the element's mean Cauchy stress is not larger [Pa]: the flow stress of its points; infinite where
/// it has no such bound (rate dependent or elastic).
double mises_most(const Elements& elements, const State& s, SlotId slot);

/// Mean eqps of an element's points (cheap: reads the history only).
double mean_eqps(const Elements& elements, const State& s, SlotId slot);
/// The same for a block: [lane].
void mean_eqps(const Elements& elements, const State& s, int block, int body, double* eqps);

}  // namespace bw::csd
