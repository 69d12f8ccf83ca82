// SPDX-License-Identifier: Apache-2.0
// The one list of solid materials and of their flow stresses.
#pragma once
#include <variant>

#include "csd/material/j2.h"
#include "csd/material/linear_flow.h"
#include "csd/material/neo_hooke.h"
#include "csd/material/saturation_flow.h"

namespace bw::csd {

using Flows = std::variant<LinearFlow, SaturationFlow>;
/// What kernels are instantiated for.
using Materials = std::variant<J2<LinearFlow>, J2<SaturationFlow>, NeoHooke>;

/// `kind = "j2"` as in the case file: the flow stress is chosen inside.
struct J2Case : Elastic {
  static constexpr auto name = "j2";
  Flows flow;
  template <class K>
  void describe(K& k) {
    Elastic::describe(k);
    struct FlowTable {
      Flows& flow;
      void describe(K& k) { k.pick("kind", flow, "flow stress", true); }
    } table{flow};
    k.table("flow", table, "flow stress as a function of the equivalent plastic strain eqps");
  }
};
struct MaterialCase {
  std::variant<J2Case, NeoHooke> choice;
  template <class K>
  void describe(K& k) {
    k.pick("kind", choice, "material", true);
  }
};

inline Materials make_material(const MaterialCase& cs) {
  if (const auto* neo_hooke = std::get_if<NeoHooke>(&cs.choice)) return *neo_hooke;
  const auto& j2 = std::get<J2Case>(cs.choice);
  return std::visit([&](const auto& flow) -> Materials { return J2(j2, flow); }, j2.flow);
}

}  // namespace bw::csd
