// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/units.h"
#include "csd/fracture/sample.h"
#include "csd/material/failure_data.h"

namespace bw::csd {

/// Spall: the mean stress (tension positive) reaches a limit.
struct SpallLimit {
  double sigma_max = 0;
  static constexpr auto name = "spall";
  static constexpr int memory = 0;
  static constexpr bool reads_pressure = true;
  template <class K>
  void describe(K& k) {
    k.optional("limit", sigma_max, dim::pressure, "mean tension at failure; 0: the material's spall_stress");
    k.expect(sigma_max >= 0, "limit", "a stress >= 0");
  }
  bool is_known(const FailureData& material) const { return sigma_max > 0 || material.spall_stress > 0; }
  void take(const FailureData& material) {
    if (sigma_max == 0) sigma_max = material.spall_stress;
  }
  bool wants_stress(const Sample&, const double*) const { return false; }
  double fail(const Sample& s, double*) const { return sigma_max > 0 ? s.sigma_m / sigma_max : 0; }
};

}  // namespace bw::csd
