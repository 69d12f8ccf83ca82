// SPDX-License-Identifier: Apache-2.0
// Hyperelastic J2 plasticity whose flow stress depends on eqps, its rate and the temperature, with heating by plastic
// work. The rate is that of the step's end (implicit), the temperature that of its start: a step heats by a few kelvin
// at most, and so the equation for the step's eqps keeps one root (VALIDATION A.2, Johnson-Cook).
#pragma once
#include "csd/material/concept.h"
#include "csd/material/flow_solver.h"
#include "csd/material/heat.h"
#include "csd/material/radial_return.h"

namespace bw::csd {

/// A flow has at(temperature), an object with
///   at_rest(eqps)       flow stress where nothing moves [Pa]: it decides on yielding
///   stress(eqps, rate)  FlowStress, >= at_rest(eqps) >= 0
/// and stress rises with the rate. It may solve for the increment of eqps itself, as increment_by_newton does, and then
/// know the flow stress at rest after it: increment(...).rest. One whose softening by heat is costly has
/// at(temperature, softening) and heated(temperature): then the history remembers the factor 1 - softening.
template <class Flow>
struct RateJ2 : Elastic {
  static constexpr auto name = "j2";
  static constexpr bool remembers = requires(Flow f) { f.at(0.0, 0.0); };
  /// A, eqps, plastic work [J/m^3], flow stress at rest beyond that of the start [Pa]; softening beyond that of the
  /// start.
  static constexpr int components = remembers ? 10 : 9;
  static constexpr bool plastic = true;
  static constexpr int points_together = 4;
  Heat heat;
  Flow flow;
  double first_yield = 0;  ///< Pa, flow stress at rest at the start
  double heating = 0;      ///< K m^3/J
  double first_softening = 0;

  RateJ2() = default;
  RateJ2(const Elastic& elastic, const Flow& flow, const Heat& heat)
      : Elastic(elastic),
        heat(heat),
        flow(flow),
        first_yield(this->flow.at(heat.initial).at_rest(0.0)),
        heating(heat.rise(density)) {
    if constexpr (remembers) first_softening = this->flow.at(heat.initial).softening;
  }

  template <class T>
  auto yields(T iso, T dev2, const double* history) const {
    const T rest = T(first_yield) + load<T>(history + 8 * lanes), k_trial = T(mu) * iso;
    return T(1.5) * k_trial * k_trial * dev2 > rest * rest;
  }
  template <class T>
  Response<T> respond(const Trial<T>& t, double* history, double per_dt) const {
    const T rest = T(first_yield) + load<T>(history + 8 * lanes);
    const T k_trial = T(mu) * t.iso;                   // s_trial = k dev b^e, eq (6)
    const T q2 = T(1.5) * k_trial * k_trial * t.dev2;  // Mises' stress squared
    const auto yields = q2 > rest * rest;
    if (!any(yields)) return {k_trial, T(1), T(0)};  // state untouched
    return flow_plastically(t, k_trial, q2, rest, yields, history, per_dt);
  }
  double plastic_work(const double* history) const { return history[7 * lanes]; }
  double temperature(const double* history) const { return heat.initial + heating * history[7 * lanes]; }

 private:
  template <class T, class Lanes>
  Response<T> flow_plastically(const Trial<T>& t, T k_trial, T q2, T rest, Lanes yields, double* history,
                               double per_dt) const {
    const T eqps = load<T>(history + 6 * lanes), work = load<T>(history + 7 * lanes);
    const auto hot = at(work, history);
    // 3 mu_bar: Mises' stress over eqps in the return; lanes that don't yield are given a solved problem
    const T q = select(yields, sqrt(q2), rest), stiffness = T(3 * mu) * (t.iso * t.third_trace);
    const auto step = increment_of(hot, q, stiffness, eqps, rest, per_dt, yields);
    const T end = max(q - stiffness * step.eqps, T(0));
    const T spent = max(end - T(0.5) * step.slope * step.eqps, T(0)) * step.eqps;  // mean stress at the step's rate
    const T work_after = select(yields, work + spent, work), eqps_after = select(yields, eqps + step.eqps, eqps);
    T rest_after;
    const T temperature = T(heat.initial) + T(heating) * work_after;
    if constexpr (remembers) {
      const auto after = hot.heated(temperature, yields);
      rest_after = step.rest * after.softened() / max(hot.softened(), T(1e-30));
      double* kept = history + 9 * lanes;
      store(kept, select(yields, after.softening - T(first_softening), load<T>(kept)));
    } else {
      rest_after = flow.at(temperature).at_rest(eqps_after);
    }
    store(history + 6 * lanes, eqps_after);
    store(history + 7 * lanes, work_after);
    store(history + 8 * lanes, select(yields, rest_after, rest) - T(first_yield));
    return radial_return(t, k_trial, end / q, yields);
  }
  template <class Hot, class T, class Lanes>
  static auto increment_of(const Hot& hot, T q, T stiffness, T eqps, T rest, double per_dt, Lanes yields) {
    if constexpr (requires { hot.increment(q, stiffness, eqps, rest, per_dt, yields); })
      return hot.increment(q, stiffness, eqps, rest, per_dt, yields);
    else
      return increment_by_newton(hot, q, stiffness, eqps, rest, per_dt, yields);
  }
  template <class T>
  auto at(T work, const double* history) const {
    const T temperature = T(heat.initial) + T(heating) * work;
    if constexpr (remembers)
      return flow.at(temperature, T(first_softening) + load<T>(history + 9 * lanes));
    else
      return flow.at(temperature);
  }
};

}  // namespace bw::csd
