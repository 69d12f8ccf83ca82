// SPDX-License-Identifier: Apache-2.0
// Johnson and Cook 1983: sigma_y = (A + B eqps^n) (1 + C ln max(rate/rate_0, 1)) (1 - T*^m), T* = (T - T_r)/(T_m - T_r)
// in [0, 1]; nothing is left at the melting temperature T_m.
#pragma once
#include "common/math/units.h"
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
      const auto large = most > T(small) * eqps;
      const T fixed = T(law.A) * softened(), part = rest - fixed, per_eqps = T(1) / max(eqps, T(1e-30));
      const T ratio_per_x = T(per_dt / law.rate_0), rated = T(law.C) * rest;
      // first guess: a step of Newton from `most` with a rough logarithm
      const T over = rated * max(rough_log(max(most * ratio_per_x, T(1))), T(0));
      T lower(0), upper = most, slope(0);
      T x = max(most - over * most / (stiffness * most + rated), T(1.0 / 16) * most);
      auto active = yields & !large;  // lanes stop one by one
      for (int i = 0; i < 100 && any(active); ++i) {
        const T xi = x * per_eqps, grown = part * power_near_one(xi, law.n), ratio = x * ratio_per_x;
        const T factor = T(1) + T(law.C) * log(max(ratio, T(1)));
        const T g = q - stiffness * x - (fixed + grown) * factor;
        const auto below = g > T(0);
        lower = select(below, x, lower);
        upper = select(below, upper, x);
        // Halley: g' = -a/x, and g'' = b/x^2 but for small terms, as the rate's part of g is -b ln x
        const T by_eqps = T(law.n) * grown * per_eqps * (T(1) - xi) * factor;
        const T b = select(ratio > T(1), T(law.C) * (fixed + grown), T(0)), a = (stiffness + by_eqps) * x + b;
        const T halley = x + T(2) * g * a * x / (T(2) * a * a - g * b);
        const T middle = select(lower > T(0), T(0.5) * (lower + upper), T(1.0 / 16) * upper);
        const T next = select((halley >= lower) & (halley <= upper), halley, middle);
        const auto moves = abs(next - x) > T(4e-3) * x;  // the step cubes it
        slope = select(active, by_eqps, slope);
        x = select(active, next, x);
        active = active & moves;
      }
      const T rest_after = fixed + part * power_near_one(x * per_eqps, law.n);
      if (!any(yields & large)) [[likely]]
        return {{x, slope}, rest_after};
      const auto step = increment_by_newton(*this, q, stiffness, eqps, rest, per_dt, yields & large);
      return {{select(large, step.eqps, x), select(large, step.slope, slope)},
              select(large, at_rest(eqps + step.eqps), rest_after)};
    }
    /// A flow stress at rest, after heating to a temperature.
    template <class Lanes>
    T heated(T rest, T temperature, Lanes yields) const {
      const T to = law.homologous(temperature), xi = (to - star) / max(star, T(1e-30));
      const auto large = xi > T(small);
      T softening_after = min(softening * power_near_one(xi, law.m), T(1));
      if (any(yields & large)) [[unlikely]]
        softening_after = select(large, law.softening(to), softening_after);
      return rest * (T(1) - softening_after) / max(softened(), T(1e-30));
    }
  };
  template <class T>
  Hot<T> at(T temperature) const {
    const T star = homologous(temperature);
    return {*this, star, softening(star)};
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
    k.expect(T_melt > T_room, "melting_temperature", "a temperature above reference_temperature");
  }

 private:
  static constexpr double small = 1.0 / 32;

  template <class T>
  T homologous(T temperature) const {
    return min(max((temperature - T(T_room)) * T(1 / (T_melt - T_room)), T(0)), T(1));
  }
  template <class T>
  T softening(T star) const {
    if (m == 1) return star;
    return select(star > T(0), exp(T(m) * log(max(star, T(1e-30)))), T(0));
  }
  template <class T>
  T power(T eqps) const {
    return exp(T(n) * log(max(eqps, T(1e-30))));
  }
  /// ln to within 0.03, from the bits.
  static Pack rough_log(Pack a) { return from_bits(Pack(bw::detail::bits_as_number<Pack::V, Mask::V>(a.v))); }
  static double rough_log(double a) {
    return from_bits(bw::detail::bits_as_number<bw::detail::D1, bw::detail::I1>(bw::detail::D1{a})[0]);
  }
  template <class T>
  static T from_bits(T n) {
    return T(0.6931471805599453) * (n * T(0x1p-32) - T(1023 - 0.043));
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
