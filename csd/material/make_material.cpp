// SPDX-License-Identifier: Apache-2.0
#include "csd/material/material_case.h"

namespace bw::csd {
namespace {

Materials make_j2(const J2Case& cs) {
  return std::visit(
      [&]<class Flow>(const Flow& flow) -> Materials {
        if constexpr (requires { J2<Flow>(cs, flow, cs.heat).flow.stress(0.0); }) {
          if (cs.rate) return RateJ2<RateFlow>(cs, RateFlow{flow, cs.rate->law}, cs.heat);
          return J2<Flow>(cs, flow, cs.heat);
        } else {
          return RateJ2<Flow>(cs, flow, cs.heat);
        }
      },
      cs.flow);
}

}  // namespace

Materials make_material(const MaterialCase& cs) {
  if (const auto* neo_hooke = std::get_if<NeoHooke>(&cs.choice)) return *neo_hooke;
  return make_j2(std::get<J2Case>(cs.choice));
}

}  // namespace bw::csd
