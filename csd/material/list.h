// SPDX-License-Identifier: Apache-2.0
// The one list of solid materials and of their flow stresses.
#pragma once
#include <variant>

#include "csd/material/j2.h"
#include "csd/material/johnson_cook.h"
#include "csd/material/linear_flow.h"
#include "csd/material/neo_hooke.h"
#include "csd/material/rate_flow.h"
#include "csd/material/saturation_flow.h"
#include "csd/material/table_flow.h"
#include "csd/material/zerilli_armstrong.h"

namespace bw::csd {

/// As in the case file: those without a rate of their own take a rate law (rate_law.h).
using Flows = std::variant<LinearFlow, SaturationFlow, TableFlow, JohnsonCook, ZerilliArmstrong>;
/// What kernels are instantiated for.
using Materials = std::variant<J2<LinearFlow>, J2<SaturationFlow>, J2<TableFlow>, RateJ2<RateFlow>, RateJ2<JohnsonCook>,
                               RateJ2<ZerilliArmstrong>, NeoHooke>;

template <Material... Ms>
constexpr bool all_are_materials(const std::variant<Ms...>*) {
  return true;
}
static_assert(all_are_materials(static_cast<const Materials*>(nullptr)));

}  // namespace bw::csd
