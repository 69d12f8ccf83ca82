// SPDX-License-Identifier: Apache-2.0
// The laws of fragment size. A new one: one header and one word here.
#pragma once
#include <concepts>
#include <variant>

#include "csd/fracture/size/fixed_width.h"
#include "csd/fracture/size/grady.h"
#include "csd/fracture/size/mott.h"

namespace bw::csd {

/// width(ring): of fragments around the axis [m], > 0, for positive radius, speed, stress and density.
template <class L>
concept SizeLaw = requires(const L& law, const RingState& ring) {
  L::name;
  { law.width(ring) } -> std::same_as<double>;
};

using SizeLaws = std::variant<Mott, Grady, FixedWidth>;

template <SizeLaw... Ls>
constexpr bool all_are_size_laws(const std::variant<Ls...>*) {
  return true;
}
static_assert(all_are_size_laws(static_cast<const SizeLaws*>(nullptr)));

inline double width(const SizeLaws& law, const RingState& ring) {
  return std::visit([&](const auto& l) { return l.width(ring); }, law);
}

}  // namespace bw::csd
