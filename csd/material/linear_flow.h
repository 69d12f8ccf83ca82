// SPDX-License-Identifier: Apache-2.0
// Flow stress with linear isotropic hardening, sigma_Y + K alpha: eq (8).
#pragma once
#include "common/math/pack.h"
#include "common/math/units.h"

namespace bw::csd {

struct LinearFlow {
  static constexpr auto name = "linear";
  double sigma_Y = 0;  ///< Pa, initial yield stress
  double K_iso = 0;    ///< Pa, hardening modulus

  template <class T>
  T stress(T eqps) const {
    return T(sigma_Y) + T(K_iso) * eqps;  // eq (8)
  }
  template <class T>
  T slope(T) const {
    return T(K_iso);
  }
  /// Int stress d(eqps) [J/m^3].
  double work(double eqps) const { return eqps * (sigma_Y + 0.5 * K_iso * eqps); }
  /// Root D >= 0 of norm - 2 mu_bar D - sqrt(2/3) stress(eqps + sqrt(2/3) D) = 0, for norm beyond the yield surface.
  template <class T>
  T multiplier(T norm, T mu_bar, T eqps) const {
    const T excess = norm - T(0.81649658092772603) * stress(eqps);
    return excess / (T(2) * mu_bar + T(2.0 / 3.0 * K_iso));  // eqs (12), (13)
  }

  template <class K>
  void describe(K& k) {
    k.required("yield_stress", sigma_Y, dim::pressure, "sigma_Y, eq (8): initial flow stress (Kirchhoff)");
    k.optional("hardening", K_iso, dim::pressure, "K, eq (8): d(flow stress)/d(equivalent plastic strain)");
    k.expect(sigma_Y > 0, "yield_stress", "a positive stress");
    k.expect(K_iso >= 0, "hardening", "a stress >= 0");
  }
};

}  // namespace bw::csd
