// SPDX-License-Identifier: Apache-2.0
// Hyperelastic J2 plasticity: eqs (1)-(13) as mended in VALIDATION A.1-A.2, in convected components (point.h).
// The return is exactly isochoric: s is returned radially, and the trace of b_bar follows from det b_bar = 1.
// Differs from Simo's box 9.1, which keeps the trace: there det C_p^-1 drifts and fakes elastic energy.
#pragma once
#include "csd/material/concept.h"

namespace bw::csd {

/// Trace/3 of b_bar = s/mu + x 1 with det b_bar = 1: root near 1 of x^3 - q/2 x + r - 1 = 0, q = |s/mu|^2, r =
/// det(s/mu). Metals have q < 1e-2, where two Newton steps with a reciprocal by series reach round-off.
template <class T>
T third_trace_of_metal(T q, T r) {
  T x = T(1) + (T(0.5) * q - r) * T(1.0 / 3.0);
  for (int i = 0; i < 2; ++i) {
    const T d = x * x - T(1) - q * T(1.0 / 6.0);  // slope / 3 - 1
    x -= (x * (x * x - T(0.5) * q) + (r - T(1))) * T(1.0 / 3.0) * (T(1) - d * (T(1) - d));
  }
  return x;
}
/// The same for any q. x_above: a value at or above the root, e.g. the trial's trace/3 (the cubic is convex and rising
/// there, so Newton comes down without overshoot). Lanes stop one by one, so that they don't see each other.
template <class T>
[[gnu::noinline]] T third_trace_by_newton(T q, T r, T x_above) {
  T x = x_above;
  for (int i = 0; i < 50; ++i) {
    const T step = (x * (x * x - T(0.5) * q) + (r - T(1))) / (T(3) * x * x - T(0.5) * q);
    const auto moves = abs(step) > T(1e-15) * x;
    x = select(moves, x - step, x);
    if (!any(moves)) break;
  }
  return x;
}
template <class T>
T isochoric_third_trace(T q, T r, T x_above) {
  const T x = third_trace_of_metal(q, r);
  const auto large = q > T(1e-2);
  if (any(large)) [[unlikely]]
    return select(large, third_trace_by_newton(q, r, x_above), x);
  return x;
}

template <class Flow>
struct J2 : Elastic {
  static constexpr auto name = "j2";
  static constexpr int components = 7;  // A, eqps
  static constexpr bool plastic = true;
  Flow flow;

  J2() = default;
  J2(const Elastic& elastic, const Flow& flow) : Elastic(elastic), flow(flow) {}

  template <class T>
  Response<T> respond(const Trial<T>& t, double* history) const {
    const T eqps = load<T>(history + 6 * lanes);
    const T k_trial = T(mu) * t.iso;                              // s_trial = k dev b^e, eq (6)
    const T s2 = k_trial * k_trial * t.dev2;                      // |s_trial|^2
    const T radius = T(0.81649658092772603) * flow.stress(eqps);  // sqrt(2/3) sigma_y, eq (7)
    const auto yields = s2 > radius * radius;                     // f > 0
    if (!any(yields)) return {k_trial, T(1), T(0)};               // state untouched
    return flow_plastically(t, k_trial, s2, eqps, yields, history);
  }
  template <class T>
  T plastic_work(T eqps) const {
    return flow.work(eqps);
  }

 private:
  /// Radial return (VALIDATION A.2, steps 4-7) of the lanes that yield; the others keep their history.
  template <class T, class Lanes>
  Response<T> flow_plastically(const Trial<T>& t, T k_trial, T s2, T eqps, Lanes yields, double* history) const {
    const T third_bar = t.iso * t.third_trace;  // tr b_bar / 3
    const T mu_bar = T(mu) * third_bar, norm = sqrt(s2);
    const T D = flow.multiplier(norm, mu_bar, eqps);  // gamma dt, eqs (10)-(13)
    const T ratio = T(1) - T(2) * mu_bar * D / norm;  // s = ratio s_trial, eq (11)
    const T e = t.iso * ratio, e2 = e * e;            // s / mu = e dev b^e
    const T x = isochoric_third_trace(e2 * t.dev2, e2 * e * t.dev_det, third_bar);
    // b_bar = s/mu + x 1, pulled back: A = ratio (A - t G) + x / iso G, as b^e = b_bar / iso; differs from eq (9):
    // exact
    const T add = x * (t.J_squared * (t.iso * t.iso)) - ratio * t.third_trace;            // 1/iso = J^2 iso^2
    store(history + 6 * lanes, select(yields, eqps + T(0.81649658092772603) * D, eqps));  // eq (8): sqrt(2/3) gamma
    return {select(yields, k_trial * ratio, k_trial), select(yields, ratio, T(1)), select(yields, add, T(0)), true};
  }
};

}  // namespace bw::csd
