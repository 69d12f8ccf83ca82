// SPDX-License-Identifier: Apache-2.0
// Johnson and Cook 1983: sigma_y = (A + B eqps^n) (1 + C ln max(rate/rate_0, 1)) (1 - T*^m), T* = (T - T_r)/(T_m - T_r)
// in [0, 1]; nothing is left at the melting temperature T_m.
#pragma once
#include "common/math/units.h"
#include "csd/material/curve.h"
#include "csd/material/rate_j2.h"

namespace bw::csd {

struct JohnsonCook {
  static constexpr auto name = "johnson_cook";
  double A = 0, B = 0;              ///< Pa
  double n = 1, C = 0, m = 1;       ///< exponents, rate coefficient
  double rate_0 = 1;                ///< 1/s
  double T_room = 293, T_melt = 0;  ///< K

  /// At one temperature. Increments are small against what has flowed, but at the very beginning: powers follow from
  /// their last value by a series, and only the rate's logarithm is left, once in most steps.
  template <class T>
  struct Hot {
    const JohnsonCook& law;
    T star, softening;  ///< T*, T*^m

    T softened() const { return T(1) - softening; }
    T at_rest(T eqps) const { return (T(law.A) + T(law.B) * law.power(eqps)) * softened(); }
    FlowStress<T> stress(T eqps, T rate) const {
      const T strain = max(eqps, T(1e-30)), part = T(law.B) * law.power(strain), hard = T(law.A) + part;
      const T ratio = rate * T(1 / law.rate_0), factor = T(1) + T(law.C) * log(max(ratio, T(1)));
      const T by_rate = select(ratio > T(1), T(law.C) / max(rate, T(law.rate_0)), T(0));
      const T soft = softened();
      return {hard * factor * soft, T(law.n) * part / strain * factor * soft, hard * by_rate * soft};
    }

    /// What increment_by_newton answers, and the flow stress at rest after it.
    struct Step : Increment<T> {
      T rest;
    };
    template <class Lanes>
    Step increment(T q, T stiffness, T eqps, T rest, double per_dt, Lanes yields) const {
      const T most = (q - rest) / stiffness;  // the flow stress is at least that at rest
      const auto virgin = most > T(4) * eqps;
      const auto large = yields & !virgin & (most > T(small) * eqps);
      const bool any_large = any(large);
      const T fixed = T(law.A) * softened(), part = rest - fixed, per_eqps = T(1) / max(eqps, T(1e-30));
      const T x_per_ratio(law.rate_0 / max(per_dt, 1e-30)), ratio_per_x(max(per_dt, 1e-30) / law.rate_0);
      const auto hardened = [&](T x) -> ValueSlope<T> {
        const T xi = x * per_eqps, near = part * power_near_one(xi, law.n);
        const ValueSlope<T> r{near, T(law.n) * near * per_eqps * (T(1) - xi)};
        if (!any_large) [[likely]]
          return r;
        const T far = part * exp(T(law.n) * log(T(1) + max(xi, T(0))));
        return {select(large, far, r.value), select(large, T(law.n) * far / (eqps + x), r.slope)};
      };
      T lower(0), upper = most, slope(0),
                  x = guess(q, stiffness, rest, part * per_eqps, most, ratio_per_x, x_per_ratio);
      auto active = yields & !virgin;  // lanes stop one by one
      for (int i = 0; i < 100 && any(active); ++i) {
        const auto [grown, rising] = hardened(x);
        const T ratio = x * ratio_per_x, factor = T(1) + T(law.C) * log(max(ratio, T(1)));
        const T g = q - stiffness * x - (fixed + grown) * factor;
        const auto below = g > T(0);
        lower = select(below, x, lower);
        upper = select(below, upper, x);
        // Halley: g' = -a/x, and g'' = b/x^2 but for small terms, as the rate's part of g is -b ln x
        const T by_eqps = rising * factor;
        const T b = select(ratio > T(1), T(law.C) * (fixed + grown), T(0)), a = (stiffness + by_eqps) * x + b;
        const T halley = x + T(2) * g * a * x / (T(2) * a * a - g * b);
        const T middle = select(lower > T(0), T(0.5) * (lower + upper), T(1.0 / 16) * upper);
        const T next = select((halley >= lower) & (halley <= upper), halley, middle);
        const auto moves = abs(next - x) > select(large, T(4e-4), T(4e-3)) * x;  // the step cubes it, nearly if large
        slope = select(active, by_eqps, slope);
        x = select(active, next, x);
        active = active & moves;
      }
      const T rest_after = fixed + hardened(x).value;
      if (!any(yields & virgin)) [[likely]]
        return {{x, slope}, rest_after};
      const auto step = increment_by_newton(*this, q, stiffness, eqps, rest, per_dt, yields & virgin);
      return {{select(virgin, step.eqps, x), select(virgin, step.slope, slope)},
              select(virgin, at_rest(eqps + step.eqps), rest_after)};
    }

    /// At another, higher temperature.
    template <class Lanes>
    Hot heated(T temperature, Lanes yields) const {
      const T to = law.homologous(temperature), xi = (to - star) / max(star, T(1e-30));
      const auto large = xi > T(small);
      T after = min(softening * power_near_one(xi, law.m), T(1));
      if (any(yields & large)) [[unlikely]]
        after = select(large, law.power_of(to), after);
      return {law, to, after};
    }

   private:
    /// Within 4e-3 where hardening is nearly linear: stiff x + rated ln(ratio) = over. Newton's method for y =
    /// ln(ratio), where it comes down from a bound without overshoot, then one better step for x.
    T guess(T q, T stiffness, T rest, T part_per_eqps, T most, T ratio_per_x, T x_per_ratio) const {
      const T rated = T(law.C) * rest, over = q - rest, stiff = stiffness + T(law.n) * part_per_eqps;
      const T per_rated = T(1) / max(rated, T(1e-30)), stiff_part = stiff * x_per_ratio * per_rated,
              z = over * per_rated;
      T y = min(short_log(max(over / stiff * ratio_per_x, T(1))), z);
      for (int i = 0; i < 3; ++i) {
        const T e = stiff_part * rough_exp(y);
        y -= (e + y - z) / (e + T(1));
      }
      const T x = min(rough_exp(max(y, T(0))) * x_per_ratio, most), a = stiff * x;
      const T b = select(x * ratio_per_x > T(1), rated, T(0));
      const T better = x + x * (over - a - b * short_log(max(x * ratio_per_x, T(1)))) / (a + b);
      return max(min(better, most), T(1.0 / 16) * x);
    }
  };
  template <class T>
  Hot<T> at(T temperature) const {
    const T star = homologous(temperature);
    return {*this, star, power_of(star)};
  }
  /// The same, with T*^m known.
  template <class T>
  Hot<T> at(T temperature, T softening) const {
    return {*this, homologous(temperature), softening};
  }

  template <class K>
  void describe(K& k) {
    k.required("yield_stress", A, dim::pressure, "A");
    k.required("hardening", B, dim::pressure, "B of A + B eqps^n");
    k.required("hardening_exponent", n, dim::none, "n");
    k.required("rate_coefficient", C, dim::none, "C of 1 + C ln(rate / reference_rate)");
    k.optional("reference_rate", rate_0, dim::frequency, "rate of plastic strain up to which the rate doesn't matter");
    k.required("softening_exponent", m, dim::none, "m of 1 - T*^m");
    k.required("melting_temperature", T_melt, dim::temperature, "where T* is 1 and the flow stress 0");
    k.optional("reference_temperature", T_room, dim::temperature, "where T* is 0");
    k.expect(A > 0, "yield_stress", "a positive stress");
    k.expect(B >= 0, "hardening", "a stress >= 0");
    k.expect(n > 0 && n <= 1, "hardening_exponent", "a number in (0, 1]");
    k.expect(C >= 0, "rate_coefficient", "a number >= 0");
    k.expect(rate_0 > 0, "reference_rate", "a positive rate");
    k.expect(m > 0, "softening_exponent", "a positive number");
    k.expect(T_room >= 0, "reference_temperature", "a temperature >= 0 K");
    k.expect(T_melt > T_room, "melting_temperature", "a temperature above reference_temperature");
  }

 private:
  static constexpr double small = 1.0 / 32;

  template <class T>
  T homologous(T temperature) const {
    return min(max((temperature - T(T_room)) * T(1 / (T_melt - T_room)), T(0)), T(1));
  }
  template <class T>
  T power_of(T star) const {  // T*^m
    if (m == 1) return star;
    return select(star > T(0), exp(T(m) * log(max(star, T(1e-30)))), T(0));
  }
  template <class T>
  T power(T eqps) const {
    return exp(T(n) * log(max(eqps, T(1e-30))));
  }
  /// (1 + xi)^a for |xi| <= small, to 1e-12.
  template <class T>
  static T power_near_one(T xi, double a) {
    T p = T(1) + T((a - 5) / 6) * xi;
    for (int k = 5; k >= 1; --k) p = T(1) + T((a - k + 1) / k) * xi * p;
    return p;
  }
};

}  // namespace bw::csd
