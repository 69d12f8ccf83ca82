// SPDX-License-Identifier: Apache-2.0
// Elastic: W = U(J) + mu/2 (tr b_bar - 3), eqs (1)-(6) without plastic flow.
#pragma once
#include "csd/material/concept.h"

namespace bw::csd {

struct NeoHooke : Elastic {
  static constexpr auto name = "neo_hooke";
  static constexpr int components = 6;
  static constexpr bool plastic = false;

  using Elastic::Elastic;

  template <class T>
  Response<T> respond(const Trial<T>& t, double*, double) const {
    return {T(mu) * t.iso, T(1), T(0)};  // eq (6)
  }
  double plastic_work(const double*) const { return 0; }
};
static_assert(Material<NeoHooke>);

}  // namespace bw::csd
