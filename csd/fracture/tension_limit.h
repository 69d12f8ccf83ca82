// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw::csd {

/// Spall: the mean stress (tension positive) reaches a limit.
struct SpallLimit {
  double sigma_max = 0;
  static constexpr auto name = "spall";
  static constexpr bool uses_stress = true;
  template <class K>
  void describe(K& k) {
    k.required("limit", sigma_max, dim::pressure, "mean tension at failure");
    k.expect(sigma_max > 0, "limit", "a positive stress");
  }
  double fail(double, const Sym3& sigma) const { return trace(sigma) / (3 * sigma_max); }
};

}  // namespace bw::csd
