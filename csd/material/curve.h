// SPDX-License-Identifier: Apache-2.0
// A function given by points: linear between them, constant outside.
#pragma once
#include <algorithm>
#include <vector>

#include "common/math/two.h"

namespace bw::csd {

template <class T>
struct ValueSlope {
  T value, slope;
};

struct Curve {
  std::vector<double> x, y;  ///< x rises, at least one point

  ValueSlope<double> at(double a) const {
    const size_t i = size_t(std::upper_bound(x.begin(), x.end(), a) - x.begin());
    if (i == 0) return {y.front(), 0};
    if (i == x.size()) return {y.back(), 0};
    const double slope = (y[i] - y[i - 1]) / (x[i] - x[i - 1]);
    return {y[i - 1] + slope * (a - x[i - 1]), slope};
  }
  ValueSlope<Pack> at(Pack a) const {  // lane by lane: lanes stand in different pieces
    ValueSlope<Pack> r;
    for (int l = 0; l < Pack::size; ++l) {
      const auto [value, slope] = at(a[l]);
      r.value.set(l, value), r.slope.set(l, slope);
    }
    return r;
  }
  template <class T, int stride>
  ValueSlope<Two<T, stride>> at(Two<T, stride> a) const {
    const ValueSlope<T> first = at(a.a), second = at(a.b);
    return {{first.value, second.value}, {first.slope, second.slope}};
  }
  /// Integral from the first point to a.
  double integral(double a) const {
    double sum = 0;
    for (size_t i = 1; i < x.size() && x[i - 1] < a; ++i) {
      const double end = std::min(x[i], a);
      sum += 0.5 * (y[i - 1] + at(end).value) * (end - x[i - 1]);
    }
    return a > x.back() ? sum + y.back() * (a - x.back()) : sum;
  }
};

}  // namespace bw::csd
