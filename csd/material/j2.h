// SPDX-License-Identifier: Apache-2.0
// Hyperelastic J2 plasticity whose flow stress depends on eqps alone: eqs (1)-(13).
#pragma once
#include "csd/material/concept.h"
#include "csd/material/heat.h"
#include "csd/material/radial_return.h"

namespace bw::csd {

/// A flow has stress(eqps) >= 0, its integral work(eqps), and multiplier(norm, mu_bar, eqps): gamma dt of the return.
template <class Flow>
struct J2 : Elastic {
  static constexpr auto name = "j2";
  static constexpr int components = 7;  // A, eqps
  static constexpr bool plastic = true;
  static constexpr int points_together = 2;
  Flow flow;
  Heat heat;

  J2() = default;
  J2(const Elastic& elastic, const Flow& flow, const Heat& heat = {}) : Elastic(elastic), flow(flow), heat(heat) {}

  template <class T>
  auto yields(T iso, T dev2, const double* history) const {
    const T k_trial = T(mu) * iso, radius = T(0.81649658092772603) * flow.stress(load<T>(history + 6 * lanes));
    return k_trial * k_trial * dev2 > radius * radius;
  }
  template <class T>
  Response<T> respond(const Trial<T>& t, double* history, double) const {
    const T eqps = load<T>(history + 6 * lanes);
    const T k_trial = T(mu) * t.iso;                              // s_trial = k dev b^e, eq (6)
    const T s2 = k_trial * k_trial * t.dev2;                      // |s_trial|^2
    const T radius = T(0.81649658092772603) * flow.stress(eqps);  // sqrt(2/3) sigma_y, eq (7)
    const auto yields = s2 > radius * radius;                     // f > 0
    if (!any(yields)) return {k_trial, T(1), T(0)};               // state untouched
    return flow_plastically(t, k_trial, s2, radius, eqps, yields, history);
  }
  double plastic_work(const double* history) const { return flow.work(history[6 * lanes]); }
  double temperature(const double* history) const { return heat.initial + heat.rise(density) * plastic_work(history); }

 private:
  /// Radial return (VALIDATION A.2, steps 4-7) of the lanes that yield; the others keep their history, and are given a
  /// solved problem.
  template <class T, class Lanes>
  Response<T> flow_plastically(const Trial<T>& t, T k_trial, T s2, T radius, T eqps, Lanes yields,
                               double* history) const {
    const T mu_bar = T(mu) * (t.iso * t.third_trace), norm = select(yields, sqrt(s2), radius);
    const T D = flow.multiplier(norm, mu_bar, eqps);                                      // gamma dt, eqs (10)-(13)
    const T ratio = T(1) - T(2) * mu_bar * D / norm;                                      // s = ratio s_trial, eq (11)
    store(history + 6 * lanes, select(yields, eqps + T(0.81649658092772603) * D, eqps));  // eq (8): sqrt(2/3) gamma
    return radial_return(t, k_trial, ratio, yields);
  }
};

}  // namespace bw::csd
