// SPDX-License-Identifier: Apache-2.0
// All pairs of forms of equations of state; visited once per range of cells, never per cell.
#pragma once
#include "cfd/mix/five_equation.h"

namespace bw::cfd {

namespace detail {
template <class... A, class... B>
std::variant<A..., B...> joined(std::variant<A...>*, std::variant<B...>*);
template <class A, class... M>
std::variant<FiveEquation<A, M>...> with_first(std::variant<M...>*);
template <class Choice, class A, class... Rest>
auto pairs(std::variant<A, Rest...>*) {
  using First = decltype(with_first<A>(static_cast<Choice*>(nullptr)));
  if constexpr (sizeof...(Rest) == 0)
    return static_cast<First*>(nullptr);
  else {
    using Others = std::remove_pointer_t<decltype(pairs<Choice>(static_cast<std::variant<Rest...>*>(nullptr)))>;
    return static_cast<decltype(joined(static_cast<First*>(nullptr), static_cast<Others*>(nullptr)))*>(nullptr);
  }
}
}  // namespace detail

/// std::variant<FiveEquation<M1, M2>...> over all pairs of EosForm.
using Mixture = std::remove_pointer_t<decltype(detail::pairs<EosForm>(static_cast<EosForm*>(nullptr)))>;

inline Mixture make_mixture(const EosChoice& first, const EosChoice& second) {
  return std::visit(
      [](const auto& a, const auto& b) -> Mixture {
        return FiveEquation<decltype(form_of(a)), decltype(form_of(b))>{form_of(a), form_of(b)};
      },
      first, second);
}
inline Closure closure(const Mixture& m) {
  return std::visit([](const auto& pair) { return pair.closure(); }, m);
}

}  // namespace bw::cfd
