// SPDX-License-Identifier: Apache-2.0
// Stiffened gas (water, solids under shock): p = (gamma - 1) rho e - gamma p_inf.
#pragma once
#include "cfd/eos/mie_gruneisen.h"
#include "common/math/units.h"

namespace bw::cfd {

struct StiffenedGas {
  static constexpr auto name = "stiffened_gas";
  static constexpr bool constant_reference = true;
  double gamma = 4.4;
  double p_inf = 6e8;

  double Gruneisen() const { return gamma - 1; }
  static constexpr double covolume() { return 0; }
  template <class T>
  Reference<T> reference(T) const {
    return {T(-gamma * p_inf), T(0), T(0), T(0)};
  }
  EosRange range() const { return {1, 3000, 1e3, 1e11}; }

  template <class Keys>
  void describe(Keys& k) {
    k.required("gamma", gamma, dim::none, "gamma of the stiffened gas");
    k.required("p_inf", p_inf, dim::pressure, "stiffening pressure");
    k.expect(gamma > 1, "gamma", "a number above 1");
    k.expect(p_inf >= 0, "p_inf", "a pressure, zero or positive");
  }
};

}  // namespace bw::cfd
