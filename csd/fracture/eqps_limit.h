// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw::csd {

/// Ductile failure: the equivalent plastic strain reaches a limit (the paper's eps_max).
struct EqpsLimit {
  double eqps_max = 0.3;
  static constexpr auto name = "eqps";
  static constexpr bool uses_stress = false;
  template <class K>
  void describe(K& k) {
    k.required("limit", eqps_max, dim::none, "equivalent plastic strain at failure");
    k.expect(eqps_max > 0, "limit", "a positive strain");
  }
  double fail(double eqps, const Sym3&) const { return eqps / eqps_max; }
};

}  // namespace bw::csd
