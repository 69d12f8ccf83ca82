// SPDX-License-Identifier: Apache-2.0
// Slope limiters: the difference over a cell from the differences to its two neighbours. Homogeneous, so that
// proportional fields get proportional slopes: what keeps p and v constant across a contact of two materials.
#pragma once
#include "common/math/pack.h"

namespace bw::cfd {

/// Monotonized central [van Leer 1977]: min(2|a|, 2|b|, |a + b|/2) with their sign, 0 at an extremum.
struct MonotonizedCentral {
  static constexpr auto name = "mc";
  template <class T>
  static T slope(T a, T b) {
    // All three positive: the first term; all three negative: the second; otherwise both vanish.
    const T a2 = a + a, b2 = b + b, centre = T(0.5) * (a + b), zero = T(0);
    return max(min(min(a2, b2), centre), zero) + min(max(max(a2, b2), centre), zero);
  }
};

}  // namespace bw::cfd
