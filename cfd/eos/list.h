// SPDX-License-Identifier: Apache-2.0
// The equations of state. Adding one = one header and one word here; the property tests run over this list.
#pragma once
#include <variant>

#include "cfd/eos/ideal_gas.h"
#include "cfd/eos/jwl.h"
#include "cfd/eos/noble_abel.h"
#include "cfd/eos/stiffened_gas.h"

namespace bw::cfd {

using EosChoice = std::variant<IdealGas, Jwl, NobleAbel, StiffenedGas>;

/// What kernels are compiled for: all models of a constant reference are one of numbers alone.
struct ConstantReference {
  static constexpr auto name = "constant_reference";
  static constexpr bool constant_reference = true;
  double G = 1, b = 0, p_ref = 0;

  ConstantReference() = default;
  template <Eos M>
  requires M::constant_reference explicit ConstantReference(const M& m)
      : G(m.Gruneisen()), b(m.covolume()), p_ref(m.reference(1.0).p) {}
  double Gruneisen() const { return G; }
  double covolume() const { return b; }
  template <class T>
  Reference<T> reference(T) const {
    return {T(p_ref), T(0), T(0), T(0)};
  }
  EosRange range() const { return {0, b > 0 ? 1 / b : 1e30, 0, 1e30}; }
};
using EosForm = std::variant<ConstantReference, Jwl>;

template <Eos M>
auto form_of(const M& m) {
  if constexpr (M::constant_reference)
    return ConstantReference(m);
  else
    return m;
}

}  // namespace bw::cfd
