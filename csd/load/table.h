// SPDX-License-Identifier: Apache-2.0
// A function of time given by points, linear between them, constant before the first and after the last.
#pragma once
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "common/math/units.h"

namespace bw::csd {

struct Table {
  std::vector<double> times, values;  ///< s, the user's quantity; times rise

  double at(double t) const {
    if (times.empty()) return 0;
    const size_t i = size_t(std::upper_bound(times.begin(), times.end(), t) - times.begin());
    if (i == 0) return values.front();
    if (i == times.size()) return values.back();
    const double w = (t - times[i - 1]) / (times[i] - times[i - 1]);
    return (1 - w) * values[i - 1] + w * values[i];
  }

  template <class K>
  void describe_with(K& k, const char* values_key, Dim dim, const char* doc) {
    k.required("times", times, dim::time, "points of the table, rising");
    k.required(values_key, values, dim, doc);
    k.expect(!times.empty() && std::is_sorted(times.begin(), times.end(), std::less_equal<>()), "times",
             "at least one time, each later than the one before");
    k.expect(values.size() == times.size(), values_key, "as many values as `times`");
  }
};

/// [factor]: lets a load or a velocity change in time.
template <class K>
void describe_factor(K& k, std::optional<Table>& factor) {
  struct Factor : Table {
    void describe(K& k) { describe_with(k, "factors", dim::none, "on the value; linear between, constant outside"); }
  };
  std::optional<Factor> table;
  k.table("factor", table, "lets it change in time");
  if (table) factor = *table;
}

}  // namespace bw::csd
