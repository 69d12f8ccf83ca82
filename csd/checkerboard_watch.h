// SPDX-License-Identifier: Apache-2.0
// Warns when the volumes' checkerboard grows, which a filter can hide but not cure (VALIDATION A.4).
#pragma once
#include <cstdint>

namespace bw::csd {

class CheckerboardWatch {
 public:
  /// The raw indicator of a row of the history. True once: its mean over the last rows has come above 0.5, or above 0.2
  /// and twice the least such mean before. Fronts in their first few elements look like one, so the first steps do not
  /// count.
  bool warns(double chi, int64_t step) {
    if (step < first_step) return false;
    sum_ += chi - last_[rows_ % window];
    last_[rows_++ % window] = chi;
    if (rows_ < window) return false;
    const double mean = sum_ / window;
    const bool grows = mean > 0.5 || (mean > 0.2 && mean > 2 * least_);
    if (mean < least_) least_ = mean;
    const bool warns = grows && !warned_;
    warned_ = warned_ || grows;
    return warns;
  }
  double mean() const { return rows_ > 0 ? sum_ / double(rows_ < window ? rows_ : window) : 0; }

 private:
  static constexpr int64_t window = 20, first_step = 200;
  double last_[window]{}, sum_ = 0, least_ = 1e300;
  int64_t rows_ = 0;
  bool warned_ = false;
};

}  // namespace bw::csd
