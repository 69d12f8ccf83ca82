// SPDX-License-Identifier: Apache-2.0
// The equations of state. Adding one = one header and one word here; the property tests run over this list.
#pragma once
#include <variant>

#include "cfd/eos/ideal_gas.h"
#include "cfd/eos/jwl.h"
#include "cfd/eos/stiffened_gas.h"

namespace bw::cfd {

using EosChoice = std::variant<IdealGas, Jwl, StiffenedGas>;

}  // namespace bw::cfd
