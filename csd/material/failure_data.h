// SPDX-License-Identifier: Apache-2.0
// What criteria of failure may ask of a material. Nothing here acts by itself: [solid.fracture] does.
#pragma once
#include <optional>

#include "common/math/units.h"

namespace bw::csd {

/// Johnson and Cook 1985: flow ends at eqps = (D1 + D2 exp(D3 s)) (1 + D4 ln(rate/rate_0)) (1 + D5 T*), where s is the
/// mean stress, tension positive, over Mises' stress (so D3 < 0), and T* the temperature's way from the reference to
/// the melting temperature.
struct DamageConstants {
  double D1 = 0, D2 = 0, D3 = 0, D4 = 0, D5 = 0;
  double rate_0 = 1;  ///< 1/s

  template <class K>
  void describe(K& k) {
    k.required("D1", D1, dim::none, "D1 of (D1 + D2 exp(D3 s)) (1 + D4 ln(rate/reference_rate)) (1 + D5 T*)");
    k.required("D2", D2, dim::none, "D2");
    k.required("D3", D3, dim::none, "D3, of s = mean stress over Mises' stress, tension positive");
    k.required("D4", D4, dim::none, "D4");
    k.required("D5", D5, dim::none, "D5");
    k.optional("reference_rate", rate_0, dim::frequency, "of D4");
    k.expect(D1 + D2 > 0, "D2", "D1 + D2 > 0: some strain at failure in pure shear");
    k.expect(D3 <= 0, "D3", "a number <= 0: tension shortens the strain at failure");
    k.expect(rate_0 > 0, "reference_rate", "a positive rate");
  }
};

struct FailureData {
  double spall_stress = 0;         ///< Pa, tension; 0: not known
  double melting_temperature = 0;  ///< K; 0: not known
  std::optional<DamageConstants> damage = {};

  template <class K>
  void describe(K& k) {
    k.optional("spall_stress", spall_stress, dim::pressure, "tension that the material bears; 0: not known");
    k.optional("melting_temperature", melting_temperature, dim::temperature,
               "where T* of `damage` is 1; 0: that of the flow stress, if it has one");
    k.table("damage", damage,
            "constants of the strain at failure [Johnson, Cook 1985], all anew for a library material");
    k.expect(spall_stress >= 0, "spall_stress", "a stress >= 0");
    k.expect(melting_temperature >= 0, "melting_temperature", "a temperature >= 0 K");
  }
};

}  // namespace bw::csd
