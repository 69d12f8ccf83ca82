// SPDX-License-Identifier: Apache-2.0
// Zerilli and Armstrong 1987, both crystal structures in one formula:
//   sigma_y = C0 + (C1 + C2 sqrt(eqps)) exp(-C3 T + C4 T ln max(rate/rate_0, 1)) + C5 eqps^n
// bcc metals have C2 = 0, fcc metals C1 = C5 = 0.
#pragma once
#include "common/math/units.h"
#include "csd/material/rate_j2.h"

namespace bw::csd {

struct ZerilliArmstrong {
  static constexpr auto name = "zerilli_armstrong";
  double C0 = 0, C1 = 0, C2 = 0;  ///< Pa
  double C3 = 0, C4 = 0;          ///< 1/K
  double C5 = 0, n = 1;           ///< Pa, exponent
  double rate_0 = 1;              ///< 1/s

  template <class T>
  struct Hot {
    const ZerilliArmstrong& law;
    T temperature;

    T at_rest(T eqps) const { return stress(eqps, T(0)).value; }
    FlowStress<T> stress(T eqps, T rate) const {
      const T strain = max(eqps, T(1e-30)), root = sqrt(strain), ratio = rate * T(1 / law.rate_0);
      const T thermal = exp(temperature * (T(law.C4) * log(max(ratio, T(1))) - T(law.C3)));
      const T active = (T(law.C1) + T(law.C2) * root) * thermal;
      const T part = law.C5 > 0 ? T(law.C5) * exp(T(law.n) * log(strain)) : T(0);
      const T by_rate = select(ratio > T(1), T(law.C4) / max(rate, T(law.rate_0)), T(0));
      return {T(law.C0) + active + part, T(0.5 * law.C2) * thermal / root + T(law.n) * part / strain,
              active * temperature * by_rate};
    }
  };
  template <class T>
  Hot<T> at(T temperature) const {
    return {*this, temperature};
  }

  template <class K>
  void describe(K& k) {
    const Dim per_kelvin{0, 0, 0, -1};
    k.optional("C0", C0, dim::pressure, "stress that nothing changes");
    k.optional("C1", C1, dim::pressure, "thermally activated stress (bcc)");
    k.optional("C2", C2, dim::pressure, "thermally activated stress over the root of eqps (fcc)");
    k.required("C3", C3, per_kelvin, "softening: exp(-C3 T)");
    k.required("C4", C4, per_kelvin, "rate: exp(C4 T ln(rate / reference_rate))");
    k.optional("C5", C5, dim::pressure, "hardening C5 eqps^n (bcc)");
    k.optional("n", n, dim::none, "its exponent");
    k.optional("reference_rate", rate_0, dim::frequency, "rate of plastic strain up to which the rate doesn't matter");
    k.expect(C0 >= 0, "C0", "a stress >= 0");
    k.expect(C1 >= 0 && C0 + C1 > 0, "C1", "a stress >= 0, and C0 + C1 > 0");
    k.expect(C2 >= 0, "C2", "a stress >= 0");
    k.expect(C3 >= 0, "C3", "a number >= 0");
    k.expect(C4 >= 0, "C4", "a number >= 0");
    k.expect(C5 >= 0, "C5", "a stress >= 0");
    k.expect(n > 0 && n <= 1, "n", "a number in (0, 1]");
    k.expect(rate_0 > 0, "reference_rate", "a positive rate");
  }
};

}  // namespace bw::csd
