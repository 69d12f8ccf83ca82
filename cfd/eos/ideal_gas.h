// SPDX-License-Identifier: Apache-2.0
// Ideal gas: p = (gamma - 1) rho e.
#pragma once
#include "cfd/eos/mie_gruneisen.h"
#include "common/math/units.h"

namespace bw::cfd {

struct IdealGas {
  static constexpr auto name = "ideal_gas";
  static constexpr bool constant_reference = true;
  double gamma = 1.4;

  double Gruneisen() const { return gamma - 1; }
  static constexpr double covolume() { return 0; }
  template <class T>
  Reference<T> reference(T) const {
    return {T(0), T(0), T(0), T(0)};
  }
  EosRange range() const { return {1e-4, 1e3, 1.0, 1e10}; }

  template <class Keys>
  void describe(Keys& k) {
    k.optional("gamma", gamma, dim::none, "ratio of specific heats");
    k.expect(gamma > 1, "gamma", "a number above 1");
  }
};

}  // namespace bw::cfd
