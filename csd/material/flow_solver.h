// SPDX-License-Identifier: Apache-2.0
// The plastic multiplier for a flow stress without closed form: VALIDATION A.2, step 4.
#pragma once
#include "common/math/pack.h"

namespace bw::csd {

/// Root D of g(D) = norm - 2 mu_bar D - sqrt(2/3) flow.stress(eqps + sqrt(2/3) D), with g(0) > 0. Newton inside a
/// bracket that shrinks in every step, bisection when Newton leaves it; to 1e-14 of the bracket. Lanes stop one by one.
/// A flow has stress(eqps) >= 0 and slope(eqps) = d stress / d eqps.
template <class T, class Flow>
T multiplier_by_newton(const Flow& flow, T norm, T mu_bar, T eqps) {
  constexpr double root = 0.81649658092772603;  // sqrt(2/3)
  T lower(0), upper = norm / (T(2) * mu_bar);   // g(lower) > 0 >= g(upper)
  const T tolerance = T(1e-14) * upper;
  T D = (norm - T(root) * flow.stress(eqps)) / (T(2) * mu_bar + T(2.0 / 3.0) * max(flow.slope(eqps), T(0)));
  D = min(max(D, lower), upper);
  for (int i = 0; i < 100; ++i) {
    const T alpha = eqps + T(root) * D;
    const T g = norm - T(2) * mu_bar * D - T(root) * flow.stress(alpha);
    const auto below = g > T(0);
    lower = select(below, D, lower);
    upper = select(below, upper, D);
    const T newton = D + g / (T(2) * mu_bar + T(2.0 / 3.0) * flow.slope(alpha));
    const T next = select((newton >= lower) & (newton <= upper), newton, T(0.5) * (lower + upper));
    const auto moves = abs(next - D) > tolerance;
    D = select(moves, next, D);
    if (!any(moves)) break;
  }
  return D;
}

}  // namespace bw::csd
