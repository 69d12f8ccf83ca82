// SPDX-License-Identifier: Apache-2.0
// Jones-Wilkins-Lee products of detonation, V = rho0/rho:
//   p = A (1 - omega/(R1 V)) e^(-R1 V) + B (1 - omega/(R2 V)) e^(-R2 V) + omega rho e.
// Mie-Grueneisen with G = omega; its reference curve is an isentrope: de_ref/drho = p_ref/rho^2.
#pragma once
#include "cfd/eos/mie_gruneisen.h"
#include "common/math/units.h"

namespace bw::cfd {

struct Jwl {
  static constexpr auto name = "jwl";
  static constexpr bool constant_reference = false;
  double A = 0, B = 0, R1 = 1, R2 = 1, omega = 0.3;
  double rho0 = 0;     ///< density of the unburnt explosive [kg/m^3]
  double E0 = 0;       ///< energy of detonation per initial volume [Pa]
  double D = 0;        ///< detonation speed as tabulated [m/s]; 0: computed from the set
  double p_CJ = 0;     ///< as tabulated [Pa]; 0: computed from the set
  double e_shift = 0;  ///< zero of e [J/kg]; an explosive that burns in the run measures e from its unburnt state,
                       ///< where p is a small difference of large numbers otherwise (cfd/eos/detonation.h)

  double Gruneisen() const { return omega; }
  static constexpr double covolume() { return 0; }
  template <class T>
  Reference<T> reference(T rho) const {
    // Beyond V = 1e4 both exponentials are zero; V < 0.05 comes from traces of a material only.
    const T V = min(max(rho0 / max(rho, T(1e-30)), T(0.05)), T(1e4));
    const T p1 = A * exp(-R1 * V), p2 = B * exp(-R2 * V);
    const T p = p1 + p2;
    return {p, (p1 * (1 / R1) + p2 * (1 / R2)) * (1 / rho0) - e_shift, V * (p1 * R1 + p2 * R2), p};
  }
  EosRange range() const { return {1e-3 * rho0, 1.6 * rho0, 1e4, 1e11}; }

  template <class Keys>
  void describe(Keys& k) {
    k.required("A", A, dim::pressure, "A");
    k.required("B", B, dim::pressure, "B");
    k.required("R1", R1, dim::none, "R1");
    k.required("R2", R2, dim::none, "R2");
    k.required("omega", omega, dim::none, "omega");
    k.required("rho0", rho0, dim::density, "density of the unburnt explosive");
    k.required("E0", E0, dim::pressure, "energy of detonation per initial volume");
    k.optional("detonation_speed", D, dim::velocity,
               "tabulated D, checked against the set; absent: computed from the set");
    k.optional("p_CJ", p_CJ, dim::pressure, "tabulated pressure of the CJ state, checked against the set");
    k.expect(A > 0, "A", "a positive pressure");
    k.expect(R1 > 0, "R1", "a positive number");
    k.expect(R2 > 0, "R2", "a positive number");
    k.expect(omega > 0, "omega", "a positive number");
    k.expect(rho0 > 0, "rho0", "a positive density");
    k.expect(E0 > 0, "E0", "a positive energy per volume");
    k.expect(D >= 0, "detonation_speed", "a positive speed");
  }
};

}  // namespace bw::cfd
