// SPDX-License-Identifier: Apache-2.0
// All pairs of forms of equations of state, and each number of materials above two; visited once per range of cells,
// never per cell.
#pragma once
#include <span>
#include <utility>

#include "cfd/mix/many_materials.h"

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
template <class... Pairs, int... more>
std::variant<Pairs..., ManyMaterials<3 + more>...> with_many(std::variant<Pairs...>*,
                                                             std::integer_sequence<int, more...>);
}  // namespace detail

/// std::variant over FiveEquation<M1, M2> of all pairs of EosForm, and ManyMaterials<3> and on.
using Mixture = decltype(detail::with_many(detail::pairs<EosForm>(static_cast<EosForm*>(nullptr)),
                                           std::make_integer_sequence<int, most_materials - 2>()));

/// Of one material (its own twin), two, or more.
inline Mixture make_mixture(std::span<const EosChoice> eos) {
  if (eos.size() <= 2)
    return std::visit(
        [](const auto& a, const auto& b) -> Mixture {
          return FiveEquation<decltype(form_of(a)), decltype(form_of(b))>{form_of(a), form_of(b)};
        },
        eos.front(), eos.back());
  const auto of = [&]<int K>(std::integral_constant<int, K>) -> Mixture {
    std::array<EosForm, K> form;
    for (size_t k = 0; k < K; ++k)
      form[k] = std::visit([](const auto& m) -> EosForm { return form_of(m); }, eos[k]);
    return ManyMaterials<K>(form);
  };
  const auto choose = [&](const auto& self, auto K) -> Mixture {
    if constexpr (K.value < most_materials)
      if (eos.size() > size_t(K.value)) return self(self, std::integral_constant<int, K.value + 1>());
    return of(K);
  };
  return choose(choose, std::integral_constant<int, 3>());
}
inline Mixture make_mixture(const EosChoice& first, const EosChoice& second) {
  const EosChoice both[2] = {first, second};
  return make_mixture(both);
}

}  // namespace bw::cfd
