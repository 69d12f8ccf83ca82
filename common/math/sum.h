// SPDX-License-Identifier: Apache-2.0
// Sums whose round-off does not grow with the number of terms (each addition's exact rounding error is kept, Knuth's
// TwoSum): books that must close to 1e-12.
#pragma once
#include <cmath>
#include <cstddef>

#include "common/math/tensor.h"

namespace bw {

/// Terms that long loops add plainly before an ExactSum gets their sum: a few rounding errors of one part, for a
/// fraction of the time.
constexpr size_t terms_at_once = 16;

class ExactSum {
 public:
  ExactSum& operator+=(double a) {
    const double t = sum_ + a, added = t - sum_;
    lost_ += (sum_ - (t - added)) + (a - added);
    sum_ = t;
    return *this;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

class ExactSum3 {
 public:
  ExactSum3& operator+=(const Vec3& a) {
    x_ += a.x;
    y_ += a.y;
    z_ += a.z;
    return *this;
  }
  Vec3 value() const { return {x_.value(), y_.value(), z_.value()}; }

 private:
  ExactSum x_, y_, z_;
};

}  // namespace bw
