// SPDX-License-Identifier: Apache-2.0
// Noble-Abel gas (dense gas, products of propellants): p (1/rho - b) = (gamma - 1) e, b the volume that its molecules
// take up.
#pragma once
#include "cfd/eos/mie_gruneisen.h"
#include "common/math/units.h"

namespace bw::cfd {

struct NobleAbel {
  static constexpr auto name = "noble_abel";
  static constexpr bool constant_reference = true;
  double gamma = 1.4;
  double b = 0;  ///< m^3/kg

  double Gruneisen() const { return gamma - 1; }
  double covolume() const { return b; }
  template <class T>
  Reference<T> reference(T) const {
    return {T(0), T(0), T(0), T(0)};
  }
  EosRange range() const { return {1e-4, b > 0 ? 0.9 / b : 1e3, 1.0, 1e10}; }

  template <class Keys>
  void describe(Keys& k) {
    k.required("gamma", gamma, dim::none, "ratio of specific heats");
    k.required("covolume", b, dim::specific_volume, "volume of the molecules themselves, per mass");
    k.expect(gamma > 1, "gamma", "a number above 1");
    k.expect(b >= 0, "covolume", "a volume per mass, zero or positive");
  }
};

}  // namespace bw::cfd
