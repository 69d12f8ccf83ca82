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
    const T centre = T(0.5) * (a + b);
    const T limit = T(2) * min(abs(a), abs(b));
    const T bounded = min(max(centre, -limit), limit);
    return select(a * b > T(0), bounded, T(0));
  }
};

}  // namespace bw::cfd
