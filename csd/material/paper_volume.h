// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/pack.h"

namespace bw::csd {

/// The paper's U(J): eqs (2), (4), (5). All numbers per bulk modulus.
struct PaperVolume {
  static constexpr auto name = "paper";

  template <class T>
  T energy(T J) const {
    return T(0.5) * (T(0.5) * (J * J - T(1)) - log(J));  // eq (2)
  }
  template <class T>
  T mean_stress(T J) const {
    return T(0.5) * (J - T(1) / J);  // eqs (4), (5)
  }
  template <class T>
  T stiffness(T J) const {
    return T(0.5) * (J + T(1) / J);
  }

  template <class K>
  void describe(K&) {}
};

}  // namespace bw::csd
