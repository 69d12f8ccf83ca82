// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/units.h"
#include "csd/fracture/sample.h"

namespace bw::csd {

/// Largest principal value; trigonometric form of the roots of a symmetric tensor's cubic.
inline double largest_principal(const Sym3& sigma) {
  const double mean = trace(sigma) / 3;
  const Sym3 s = deviator(sigma);
  const double J2 = 0.5 * contract(s, s);
  if (!(J2 > 0)) return mean;
  const double radius = 2 * std::sqrt(J2 / 3);
  const double cos3 = std::clamp(4 * det(s) / (radius * radius * radius), -1.0, 1.0);
  return mean + radius * std::cos(std::acos(cos3) / 3);
}

/// Brittle failure: the largest principal stress has been above a limit for a time on end.
struct PrincipalStress {
  double sigma_max = 0, duration = 0;
  static constexpr auto name = "principal_stress";
  static constexpr int memory = 1;  // s, above the limit without a break
  static constexpr bool reads_pressure = true;
  template <class K>
  void describe(K& k) {
    k.required("limit", sigma_max, dim::pressure, "largest principal stress");
    k.required("duration", duration, dim::time, "that it must stay above the limit, without a break");
    k.expect(sigma_max > 0, "limit", "a positive stress");
    k.expect(duration > 0, "duration", "a positive time");
  }
  /// sigma_1 - sigma_m is at most two thirds of Mises' stress.
  bool wants_stress(const Sample& s, const double*) const { return s.sigma_m + s.mises_most * (2.0 / 3) >= sigma_max; }
  /// The part of the duration that has passed; an element whose stress is not wanted can't be above the limit.
  double fail(const Sample& s, double* above) const {
    *above = s.has_stress && largest_principal(s.sigma) >= sigma_max ? *above + s.dt : 0;
    return *above / duration;
  }
};

}  // namespace bw::csd
