// SPDX-License-Identifier: Apache-2.0
// The failure criteria. A new one: one header and one word here.
#pragma once
#include <concepts>
#include <variant>

#include "csd/fracture/eqps_limit.h"
#include "csd/fracture/tension_limit.h"

namespace bw::csd {

/// Failure value of an element from its mean equivalent plastic strain and mean Cauchy stress: 1 or more is broken.
template <class C>
concept Criterion = requires(const C& c, double eqps, const Sym3& sigma) {
  C::name;
  { C::uses_stress } -> std::convertible_to<bool>;
  { c.fail(eqps, sigma) } -> std::same_as<double>;
};

using Criteria = std::variant<EqpsLimit, SpallLimit>;

template <Criterion... Cs>
constexpr bool all_are_criteria(const std::variant<Cs...>*) {
  return true;
}
static_assert(all_are_criteria(static_cast<const Criteria*>(nullptr)));

}  // namespace bw::csd
