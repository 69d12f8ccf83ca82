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

  template <class T>
  struct Hot {
    const JohnsonCook& law;
    T softened;  ///< 1 - T*^m

    T at_rest(T eqps) const { return (T(law.A) + T(law.B) * law.power(eqps)) * softened; }
    FlowStress<T> stress(T eqps, T rate) const {
      const T strain = max(eqps, T(1e-30)), part = T(law.B) * law.power(strain), hard = T(law.A) + part;
      const T ratio = rate * T(1 / law.rate_0), factor = T(1) + T(law.C) * log(max(ratio, T(1)));
      const T by_rate = select(ratio > T(1), T(law.C) / max(rate, T(law.rate_0)), T(0));
      return {hard * factor * softened, T(law.n) * part / strain * factor * softened, hard * by_rate * softened};
    }
  };
  template <class T>
  Hot<T> at(T temperature) const {
    const T star = min(max((temperature - T(T_room)) * T(1 / (T_melt - T_room)), T(0)), T(1));
    if (m == 1) return {*this, T(1) - star};
    return {*this, T(1) - select(star > T(0), exp(T(m) * log(max(star, T(1e-30)))), T(0))};
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
  template <class T>
  T power(T eqps) const {
    return exp(T(n) * log(max(eqps, T(1e-30))));
  }
};

}  // namespace bw::csd
