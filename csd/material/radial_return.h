// SPDX-License-Identifier: Apache-2.0
// What flow by gamma dt = D leaves behind: eqs (9)-(11) as mended in VALIDATION A.2, steps 5-7, in convected components
// (point.h). The return is exactly isochoric: s is returned radially, and the trace of b_bar follows from det b_bar
// = 1. Differs from Simo's box 9.1, which keeps the trace: there det C_p^-1 drifts and fakes elastic energy.
#pragma once
#include "csd/material/point.h"

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

/// The lanes that yield end with s = ratio s_trial, eq (11); the others stay. k_trial [Pa]: s_trial = k_trial dev b^e.
template <class T, class Lanes>
Response<T> radial_return(const Trial<T>& t, T k_trial, T ratio, Lanes yields) {
  const T e = t.iso * ratio, e2 = e * e;  // s / mu = e dev b^e
  const T x = isochoric_third_trace(e2 * t.dev2, e2 * e * t.dev_det, t.iso * t.third_trace);
  // b_bar = s/mu + x 1, pulled back: A = ratio (A - t G) + x / iso G, as b^e = b_bar / iso; differs from eq (9): exact
  const T add = x * (t.J_squared * (t.iso * t.iso)) - ratio * t.third_trace;  // 1/iso = J^2 iso^2
  return {select(yields, k_trial * ratio, k_trial), select(yields, ratio, T(1)), select(yields, add, T(0))};
}

}  // namespace bw::csd
