// SPDX-License-Identifier: Apache-2.0
// Hyperelastic J2 plasticity: eqs (1)-(13) as mended in VALIDATION A.1-A.2, in convected components (point.h).
// The return is exactly isochoric: s is returned radially, and the trace of b_bar follows from det b_bar = 1.
// Differs from Simo's box 9.1, which keeps the trace: there det C_p^-1 drifts and fakes elastic energy.
#pragma once
#include "csd/material/concept.h"

namespace bw::csd {

/// Root near tr b_bar / 3 of x^3 - q/2 x + r - 1 = 0: the trace/3 of b_bar = s/mu + x 1 with det b_bar = 1, where
/// q = |s/mu|^2 and r = det(s/mu). x_above: any value at or above the root, e.g. the trial trace/3 (the cubic is convex
/// and rising there, so Newton comes down without overshoot). Lanes stop one by one, so that they don't see each other.
template <class T>
T isochoric_third_trace(T q, T r, T x_above) {
  const T near_one = T(1) + (T(0.5) * q - r) / (T(3) - T(0.5) * q);  // first order in q, r
  T x = select(q < T(1), min(near_one, x_above), x_above);
  for (int i = 0; i < 30; ++i) {
    const T step = (x * (x * x - T(0.5) * q) + r - T(1)) / (T(3) * x * x - T(0.5) * q);
    const auto moves = abs(step) > T(1e-15) * x;
    x = select(moves, x - step, x);
    if (!any(moves)) break;
  }
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
  T deviator(const Point<T>& p, double* history) const {
    const T eqps = load<T>(history + 6 * lanes);
    const T k_trial = T(mu) * p.iso;                                    // s_trial = k dev b^e, eq (6)
    const T s2 = k_trial * k_trial * contract(p.dev_b, p.dev_b);        // |s_trial|^2
    const T radius = T(0.81649658092772603) * flow.stress(eqps);        // sqrt(2/3) sigma_y, eq (7)
    const auto yields = s2 > radius * radius;                           // f > 0
    if (!any(yields)) [[likely]] return k_trial;                        // state untouched
    return select(yields, k_trial * flow_plastically(p, k_trial, sqrt(s2), eqps, yields, history), k_trial);
  }
  template <class T>
  T plastic_work(T eqps) const {
    return flow.work(eqps);
  }

 private:
  /// Radial return (VALIDATION A.2, steps 4-7) of the lanes that yield; the others keep their history. Returns
  /// |s| / |s_trial|.
  template <class T, class M>
  T flow_plastically(const Point<T>& p, T k_trial, T norm, T eqps, M yields, double* history) const {
    const T third_bar = p.iso * p.third_trace;                          // tr b_bar / 3
    const T mu_bar = T(mu) * third_bar;
    const T D = flow.multiplier(norm, mu_bar, eqps);                    // gamma dt, eqs (10)-(13)
    const T ratio = T(1) - T(2) * mu_bar * D / norm;                    // s = ratio s_trial, eq (11)
    const T e = k_trial * T(1 / mu) * ratio;                            // s / mu = e dev b^e
    const T x = isochoric_third_trace(e * e * contract(p.dev_b, p.dev_b), e * e * e * det(p.dev_b), third_bar);
    // b_bar = s/mu + x 1, pulled back: A = ratio (A - t G) + x / iso G,  b^e = b_bar / iso
    const Sym<T> A = ratio * p.A + (x / p.iso - ratio * p.third_trace) * p.metric();  // differs from eq (9): exact
    const auto keep = [&](T fresh, T old) { return select(yields, fresh, old); };
    store_sym(history, Sym<T>{keep(A.xx, p.A.xx), keep(A.yy, p.A.yy), keep(A.zz, p.A.zz), keep(A.xy, p.A.xy),
                              keep(A.xz, p.A.xz), keep(A.yz, p.A.yz)});
    store(history + 6 * lanes, keep(eqps + T(0.81649658092772603) * D, eqps));  // eq (8): d(alpha) = sqrt(2/3) gamma
    return ratio;
  }
};
}  // namespace bw::csd
