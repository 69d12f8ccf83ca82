// SPDX-License-Identifier: Apache-2.0
// Roots of one unknown: Newton's steps kept inside a bracket, bisection where they would leave it.
#pragma once
#include <cmath>
#include <utility>

#include "common/math/pack.h"

namespace bw {

struct Root {
  double x = 0;
  int steps = 0;
  bool converged = false;  ///< false: no change of sign in the bracket, or max_steps
};

/// f(x) returns {value, slope}; f(lo) and f(hi) differ in sign. Converged when the step or the bracket is below
/// x_tolerance.
template <class F>
Root find_root(const F& f, double lo, double hi, double x_tolerance, int max_steps = 200) {
  const double f_lo = f(lo).first, f_hi = f(hi).first;
  if (f_lo == 0) return {lo, 0, true};
  if (f_hi == 0) return {hi, 0, true};
  if (!((f_lo < 0) != (f_hi < 0)) || std::isnan(f_lo + f_hi)) return {lo, 0, false};
  const bool rising = f_lo < 0;
  double x = 0.5 * (lo + hi), last_step = hi - lo;
  for (int n = 1; n <= max_steps; ++n) {
    const auto [value, slope] = f(x);
    if (value == 0) return {x, n, true};
    ((value < 0) == rising ? lo : hi) = x;
    double next = x - value / slope;
    // Newton's step must stay inside and be at most half of the last one, or it may circle
    if (!(next >= lo && next <= hi) || std::abs(next - x) > 0.5 * std::abs(last_step)) next = 0.5 * (lo + hi);
    last_step = next - x;
    x = next;
    if (std::abs(last_step) <= x_tolerance || hi - lo <= x_tolerance) return {x, n, true};
  }
  return {x, max_steps, false};
}

/// For kernels, T = double or Pack: `trips` steps, no branch. f rises over [lo, hi] and f(x) returns {value, slope}; a
/// root outside the bracket ends at its nearer end.
template <class T, class F>
T newton_in_bracket(const F& f, T lo, T hi, T x, int trips) {
  for (int n = 0; n < trips; ++n) {
    const auto [value, slope] = f(x);
    const auto below = value < T(0.0);
    lo = select(below, x, lo);
    hi = select(below, hi, x);
    const T next = x - value / slope;
    const auto inside = (next >= lo) & (next <= hi);
    x = select(inside, next, T(0.5) * (lo + hi));
  }
  return x;
}

}  // namespace bw
