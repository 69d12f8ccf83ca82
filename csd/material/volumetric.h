// SPDX-License-Identifier: Apache-2.0
// Volumetric part of the stored energy: eqs (2), (4), (5). Mean stress sigma_m is tension positive everywhere in csd.
#pragma once
#include "common/math/pack.h"

namespace bw::csd {

struct Volumetric {
  double kappa = 0;  ///< Pa, bulk modulus

  /// J/m^3 of reference volume.
  template <class T>
  T energy(T J) const {
    return T(0.5 * kappa) * (T(0.5) * (J * J - T(1)) - log(J));  // eq (2)
  }
  /// sigma_m = U'(J) [Pa].
  template <class T>
  T mean_stress(T J) const {
    return T(0.5 * kappa) * (J - T(1) / J);  // eqs (4), (5)
  }
  /// J U''(J) [Pa]: stiffness of the current volume against dilatation.
  template <class T>
  T stiffness(T J) const {
    return T(0.5 * kappa) * (J + T(1) / J);
  }
};

}  // namespace bw::csd
