// SPDX-License-Identifier: Apache-2.0
// The failure criteria. A new one: one header and one word here.
#pragma once
#include <concepts>
#include <variant>

#include "csd/fracture/eqps_limit.h"
#include "csd/fracture/johnson_cook_damage.h"
#include "csd/fracture/principal_stress.h"
#include "csd/fracture/spall_limit.h"

namespace bw::csd {

/// Failure of an element: a value that is 1 or more when it is broken.
///   C::name            the word in the case file
///   C::memory          numbers that it keeps for each element, 0 at the start
///   C::reads_pressure  whether it reads Sample::sigma_m and mises_most
///   wants_stress(sample, memory)  whether fail() must know the stress this time; most elements are spared it
///   fail(sample, memory)          failure value after the step; renews the memory
/// Those that ask the body's material also have
///   is_known(material)             whether it has what they need
///   take(material)                 takes it over
template <class C>
concept Criterion = requires(const C& c, const Sample& sample, double* memory) {
  C::name;
  { C::memory } -> std::convertible_to<int>;
  { C::reads_pressure } -> std::convertible_to<bool>;
  { c.wants_stress(sample, memory) } -> std::same_as<bool>;
  { c.fail(sample, memory) } -> std::same_as<double>;
};

using Criteria = std::variant<EqpsLimit, JohnsonCookDamage, PrincipalStress, SpallLimit>;

template <Criterion... Cs>
constexpr bool all_are_criteria(const std::variant<Cs...>*) {
  return true;
}
static_assert(all_are_criteria(static_cast<const Criteria*>(nullptr)));

}  // namespace bw::csd
