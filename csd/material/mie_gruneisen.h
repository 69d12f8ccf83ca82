// SPDX-License-Identifier: Apache-2.0
// Mie-Gruneisen with shock speed U_s = c0 + s u_p, on its reference curve, the principal Hugoniot: with y = 1 - J,
//   p = rho_0 c0^2 y / (1 - s y)^2            so that shocks into material at rest have exactly that speed
// and bulk modulus rho_0 c0^2 at rest. Heat adds no pressure: release follows the same curve, which errs in the third
// order of y. In tension sigma_m = kappa (1 - 1/J), what usual codes take.
#pragma once
#include "common/math/pack.h"
#include "common/math/units.h"

namespace bw::csd {

/// All numbers per bulk modulus.
struct MieGruneisen {
  static constexpr auto name = "mie_gruneisen";
  double c0 = 0;  ///< m/s
  double s = 0;   ///< slope of U_s over u_p
  /// Where s y ends: beyond, the pressure goes on along its tangent (the limit of compression is s y = 1).
  static constexpr double most = 0.8;

  template <class T>
  T energy(T J) const {
    const T y = T(1) - J, z = min(T(s) * y, T(most)), left = T(1) - z, beyond = y - z * T(1 / s);
    const T compressed = (log(left) + T(1) / left - T(1)) * T(1 / (s * s)) +
                         beyond * (pressure(z, left) + T(0.5) * slope(z, left) * beyond);
    return select(J < T(1), compressed, J - T(1) - log(J));
  }
  template <class T>
  T mean_stress(T J) const {
    const T y = T(1) - J, z = min(T(s) * y, T(most)), left = T(1) - z, beyond = y - z * T(1 / s);
    return select(J < T(1), -(pressure(z, left) + slope(z, left) * beyond), T(1) - T(1) / J);
  }
  template <class T>
  T stiffness(T J) const {
    const T z = min(T(s) * (T(1) - J), T(most));
    return select(J < T(1), J * slope(z, T(1) - z), T(1) / J);
  }

  template <class K>
  void describe(K& k) {
    k.required("hugoniot_speed", c0, dim::velocity, "c0 of U_s = c0 + s u_p; the bulk modulus becomes density c0^2");
    k.required("hugoniot_slope", s, dim::none, "s of U_s = c0 + s u_p");
    k.expect(c0 > 0, "hugoniot_speed", "a positive speed");
    k.expect(s > 0, "hugoniot_slope", "a positive number");
  }

 private:
  template <class T>
  T pressure(T z, T left) const {
    return z * T(1 / s) / (left * left);
  }
  template <class T>
  T slope(T z, T left) const {
    return (T(1) + z) / (left * left * left);
  }
};

}  // namespace bw::csd
