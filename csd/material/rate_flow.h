// SPDX-License-Identifier: Apache-2.0
// A flow stress at rest times a factor by rate.
#pragma once
#include <variant>

#include "csd/material/linear_flow.h"
#include "csd/material/rate_j2.h"
#include "csd/material/rate_law.h"
#include "csd/material/saturation_flow.h"
#include "csd/material/table_flow.h"

namespace bw::csd {

/// The choice is a branch, not a template argument: the laws cost more than it.
struct RateFlow {
  static constexpr auto name = "rate";
  std::variant<LinearFlow, SaturationFlow, TableFlow> rest;
  RateLaws law;

  template <class T>
  const RateFlow& at(T) const {
    return *this;  // the temperature doesn't matter
  }
  template <class T>
  [[gnu::noinline]] T at_rest(T eqps) const {
    return std::visit([&](const auto& flow) { return flow.stress(eqps); }, rest);
  }
  template <class T>
  [[gnu::noinline]] FlowStress<T> stress(T eqps, T rate) const {
    const ValueSlope<T> s = std::visit(
        [&](const auto& flow) {
          return ValueSlope<T>{flow.stress(eqps), flow.slope(eqps)};
        },
        rest);
    const ValueSlope<T> factor = std::visit([&](const auto& l) { return l.at(rate); }, law);
    return {s.value * factor.value, s.slope * factor.value, s.value * factor.slope};
  }
};

}  // namespace bw::csd
