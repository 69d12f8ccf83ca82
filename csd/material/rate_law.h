// SPDX-License-Identifier: Apache-2.0
// How a rate of plastic strain raises a flow stress: a factor on the stress at rest.
#pragma once
#include <cmath>
#include <variant>

#include "common/math/pack.h"
#include "common/math/units.h"
#include "csd/material/curve.h"

namespace bw::csd {

/// 1 + (rate/D)^(1/q) [Cowper, Symonds 1957].
struct CowperSymonds {
  static constexpr auto name = "cowper_symonds";
  double D = 0, q = 0;  ///< 1/s, 1

  /// Factor and its slope over the rate [s].
  template <class T>
  ValueSlope<T> at(T rate) const {
    const T r = max(rate, T(1e-30)), power = exp(T(1 / q) * log(r * T(1 / D)));
    return {T(1) + power, T(1 / q) * power / r};
  }
  template <class K>
  void describe(K& k) {
    k.required("rate", D, dim::frequency, "D of 1 + (rate/D)^(1/q): the rate that doubles the flow stress");
    k.required("exponent", q, dim::none, "q");
    k.expect(D > 0, "rate", "a positive rate");
    k.expect(q > 0, "exponent", "a positive number");
  }
};

/// Dynamic increase factor by a table, linear in the logarithm of the rate, constant outside.
struct IncreaseFactor {
  static constexpr auto name = "increase_factor";
  std::vector<double> rates, factors;  ///< 1/s, 1
  Curve curve;                         ///< over ln(rate)

  template <class T>
  ValueSlope<T> at(T rate) const {
    const T r = max(rate, T(1e-30));
    const auto [value, slope] = curve.at(T(log(r)));
    return {value, slope / r};
  }
  template <class K>
  void describe(K& k) {
    k.required("rates", rates, dim::frequency, "rates of plastic strain, rising");
    k.required("factors", factors, dim::none, "flow stress over that at rest; linear in the logarithm of the rate");
    k.expect(!rates.empty() && rates[0] > 0 && std::is_sorted(rates.begin(), rates.end(), std::less_equal<>()), "rates",
             "positive rates, each larger than the one before");
    k.expect(factors.size() == rates.size(), "factors", "as many factors as `rates`");
    k.expect(std::is_sorted(factors.begin(), factors.end()) && !factors.empty() && factors[0] >= 1, "factors",
             "factors from 1 on, none smaller than the one before");
    set(rates, factors);
  }
  void set(const std::vector<double>& at_rates, const std::vector<double>& values) {
    rates = at_rates, factors = values, curve = {{}, values};
    for (double r : rates) curve.x.push_back(std::log(r));
  }
};

using RateLaws = std::variant<CowperSymonds, IncreaseFactor>;

}  // namespace bw::csd
