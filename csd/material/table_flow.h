// SPDX-License-Identifier: Apache-2.0
// Flow stress by a table, for measured curves.
#pragma once
#include "common/math/units.h"
#include "csd/material/curve.h"
#include "csd/material/flow_solver.h"

namespace bw::csd {

struct TableFlow {
  static constexpr auto name = "table";
  Curve curve;  ///< eqps, Pa

  template <class T>
  T stress(T eqps) const {
    return curve.at(eqps).value;
  }
  template <class T>
  T slope(T eqps) const {
    return curve.at(eqps).slope;
  }
  double work(double eqps) const { return curve.integral(eqps); }
  template <class T>
  T multiplier(T norm, T mu_bar, T eqps) const {
    return multiplier_by_newton(*this, norm, mu_bar, eqps);
  }

  template <class K>
  void describe(K& k) {
    k.required("eqps", curve.x, dim::none, "equivalent plastic strains, rising from 0");
    k.required("stresses", curve.y, dim::pressure, "flow stress at each; linear between, constant after the last");
    k.expect(!curve.x.empty() && curve.x[0] == 0 && std::is_sorted(curve.x.begin(), curve.x.end(), std::less_equal<>()),
             "eqps", "strains from 0 on, each larger than the one before");
    k.expect(curve.y.size() == curve.x.size(), "stresses", "as many stresses as `eqps`");
    k.expect(std::all_of(curve.y.begin(), curve.y.end(), [](double y) { return y > 0; }), "stresses",
             "positive stresses");
  }
};

}  // namespace bw::csd
