// SPDX-License-Identifier: Apache-2.0
// Flow stress that saturates: sigma_Y + K alpha + (sigma_inf - sigma_Y) (1 - exp(-delta alpha)) [Simo 1988].
#pragma once
#include "common/math/units.h"
#include "csd/material/flow_solver.h"

namespace bw::csd {

struct SaturationFlow {
  static constexpr auto name = "saturation";
  double sigma_Y = 0;    ///< Pa, initial yield stress
  double K_iso = 0;      ///< Pa, linear hardening
  double sigma_inf = 0;  ///< Pa, saturation stress
  double delta = 0;      ///< saturation exponent

  template <class T>
  T stress(T eqps) const {
    return T(sigma_Y) + T(K_iso) * eqps + T(sigma_inf - sigma_Y) * (T(1) - exp(T(-delta) * eqps));
  }
  template <class T>
  T slope(T eqps) const {
    return T(K_iso) + T((sigma_inf - sigma_Y) * delta) * exp(T(-delta) * eqps);
  }
  double work(double eqps) const {
    return eqps * (sigma_inf + 0.5 * K_iso * eqps) - (sigma_inf - sigma_Y) * (1 - exp(-delta * eqps)) / delta;
  }
  template <class T>
  T multiplier(T norm, T mu_bar, T eqps) const {
    return multiplier_by_newton(*this, norm, mu_bar, eqps);
  }

  template <class K>
  void describe(K& k) {
    k.required("yield_stress", sigma_Y, dim::pressure, "initial flow stress (Kirchhoff)");
    k.optional("hardening", K_iso, dim::pressure, "linear part of the hardening");
    k.required("saturation_stress", sigma_inf, dim::pressure, "flow stress that the exponential part tends to");
    k.required("saturation_exponent", delta, dim::none, "delta of 1 - exp(-delta eqps)");
    k.expect(sigma_Y > 0, "yield_stress", "a positive stress");
    k.expect(K_iso >= 0, "hardening", "a stress >= 0");
    k.expect(sigma_inf >= sigma_Y, "saturation_stress", "a stress >= yield_stress");
    k.expect(delta > 0, "saturation_exponent", "a positive number");
  }
};

}  // namespace bw::csd
