// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/units.h"
#include "csd/fracture/sample.h"

namespace bw::csd {

/// Ductile failure: the equivalent plastic strain reaches a limit (the paper's eps_max).
struct EqpsLimit {
  double eqps_max = 0.3;
  static constexpr auto name = "eqps";
  static constexpr int memory = 0;
  static constexpr bool reads_pressure = false;
  template <class K>
  void describe(K& k) {
    k.required("limit", eqps_max, dim::none, "equivalent plastic strain at failure");
    k.expect(eqps_max > 0, "limit", "a positive strain");
  }
  bool wants_stress(const Sample&, const double*) const { return false; }
  double fail(const Sample& s, double*) const { return s.eqps / eqps_max; }
};

}  // namespace bw::csd
