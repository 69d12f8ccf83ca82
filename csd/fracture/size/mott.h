// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "common/math/units.h"
#include "csd/fracture/size/ring.h"

namespace bw::csd {

/// Mott's width of fragments, eq (17), with the square root that makes its units right.
struct Mott {
  double gamma = 56, strength = 0;
  static constexpr auto name = "mott";
  template <class K>
  void describe(K& k) {
    k.optional("gamma", gamma, dim::none, "gamma' of eq (17)");
    k.optional("strength", strength, dim::pressure,
               "sigma_F of eq (17); 0: the ring's flow stress at its strain, rate and temperature");
    k.expect(gamma > 0, "gamma", "a positive number");
    k.expect(strength >= 0, "strength", "a stress >= 0");
  }
  double width(const RingState& ring) const {
    const double sigma_F = strength > 0 ? strength : ring.stress;
    return std::sqrt(2 * sigma_F / (ring.density * gamma)) * ring.radius / ring.speed;  // eq (17)
  }
};

}  // namespace bw::csd
