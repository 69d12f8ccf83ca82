// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "common/math/units.h"
#include "csd/fracture/size/ring.h"

namespace bw::csd {

/// Grady's balance of the kinetic energy of a fragment's expansion with the energy of its faces: (24 G / (rho
/// rate^2))^(1/3) [Grady 1982, J. Appl. Phys. 53, 322; VALIDATION S10].
struct Grady {
  double energy = 0;
  static constexpr auto name = "grady";
  template <class K>
  void describe(K& k) {
    k.required("fracture_energy", energy, dim::stiffness, "energy that a crack takes per area (J/m^2)");
    k.expect(energy > 0, "fracture_energy", "a positive energy per area");
  }
  double width(const RingState& ring) const {
    const double rate = ring.speed / ring.radius;
    return std::cbrt(24 * energy / (ring.density * rate * rate));
  }
};

}  // namespace bw::csd
