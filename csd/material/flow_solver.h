// SPDX-License-Identifier: Apache-2.0
// The plastic multiplier for a flow stress without closed form: VALIDATION A.2, step 4.
#pragma once
#include "common/math/pack.h"

namespace bw::csd {

/// Root D of g(D) = norm - 2 mu_bar D - sqrt(2/3) flow.stress(eqps + sqrt(2/3) D), with g(0) >= 0. Newton inside a
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

/// Flow stress [Pa] and its slopes over eqps [Pa] and rate [Pa s].
template <class T>
struct FlowStress {
  T value, by_eqps, by_rate;
};
/// Change of eqps in a step, and the slope of the flow stress over eqps at its end [Pa].
template <class T>
struct Increment {
  T eqps, slope;
};

/// Root x of g(x) = q - stiffness x - hot.stress(eqps + x, x per_dt), with g(0) > 0 in the lanes that yield; rest =
/// hot.stress(eqps, 0) or near it. A stress that grows with the logarithm of the rate makes g steep and then flat, so
/// where Newton leaves the bracket and nothing is known below, the upper end falls to a sixteenth; else bisection. Ends
/// with Newton's step from |g| < 1e-8 q, which squares it.
template <class T, class Hot, class Lanes>
Increment<T> increment_by_newton(const Hot& hot, T q, T stiffness, T eqps, T rest, double per_dt, Lanes yields) {
  T lower(0), upper = q / stiffness, slope(0);
  T x = min(max((q - rest) / stiffness, T(1e-6) * upper), upper);
  auto active = yields;  // lanes stop one by one
  for (int i = 0; i < 100; ++i) {
    const auto [value, by_eqps, by_rate] = hot.stress(eqps + x, x * T(per_dt));
    const T g = q - stiffness * x - value;
    const auto below = g > T(0);
    lower = select(below, x, lower);
    upper = select(below, upper, x);
    const T newton = x + g / (stiffness + by_eqps + by_rate * T(per_dt));
    const T middle = select(lower > T(0), T(0.5) * (lower + upper), T(1.0 / 16) * upper);
    const T next = select((newton >= lower) & (newton <= upper), newton, middle);
    const auto moves = abs(g) > T(1e-8) * q;
    slope = select(active, by_eqps, slope);
    x = select(active, next, x);
    active = active & moves;
    if (!any(active)) break;
  }
  return {x, slope};
}

}  // namespace bw::csd
