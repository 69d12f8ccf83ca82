// SPDX-License-Identifier: Apache-2.0
// What plastic work becomes: heat that stays where it is (adiabatic), the rest stored in the lattice.
#pragma once
#include "common/math/units.h"

namespace bw::csd {

struct Heat {
  double specific_heat = 0;     ///< J/(kg K); 0: the temperature stays
  double taylor_quinney = 0.9;  ///< share of the plastic work that heats
  double initial = 293;         ///< K

  /// K m^3/J: rise of the temperature over plastic work per reference volume.
  double rise(double density) const { return specific_heat > 0 ? taylor_quinney / (density * specific_heat) : 0; }

  template <class K>
  void describe(K& k) {
    k.optional("specific_heat", specific_heat, dim::specific_heat, "0: plastic work does not heat");
    k.optional("taylor_quinney", taylor_quinney, dim::none, "share of the plastic work that becomes heat");
    k.optional("temperature", initial, dim::temperature, "at the start");
    k.expect(specific_heat >= 0, "specific_heat", "a specific heat >= 0");
    k.expect(taylor_quinney >= 0 && taylor_quinney <= 1, "taylor_quinney", "a number in [0, 1]");
    k.expect(initial >= 0, "temperature", "a temperature >= 0 K");
  }
};

}  // namespace bw::csd
