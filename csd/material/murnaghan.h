// SPDX-License-Identifier: Apache-2.0
// Murnaghan 1944: a bulk modulus that grows linearly with the pressure, p = kappa/k' (J^-k' - 1).
#pragma once
#include "common/math/pack.h"
#include "common/math/units.h"

namespace bw::csd {

/// All numbers per bulk modulus.
struct Murnaghan {
  static constexpr auto name = "murnaghan";
  double growth = 0;  ///< k' = d kappa / dp at rest

  template <class T>
  T energy(T J) const {
    return ((J - T(1)) + (J * power(J) - T(1)) * T(1 / (growth - 1))) * T(1 / growth);
  }
  template <class T>
  T mean_stress(T J) const {
    return (T(1) - power(J)) * T(1 / growth);
  }
  template <class T>
  T stiffness(T J) const {
    return power(J);
  }

  template <class K>
  void describe(K& k) {
    k.required("bulk_modulus_slope", growth, dim::none, "k' = d(bulk modulus)/d(pressure), 4 to 6 for most metals");
    k.expect(growth > 1, "bulk_modulus_slope", "a number above 1");
  }

 private:
  template <class T>
  T power(T J) const {
    return exp(T(-growth) * log(J));
  }
};

}  // namespace bw::csd
