// SPDX-License-Identifier: Apache-2.0
#include "common/app/run_control.h"

#include <cmath>

namespace bw {

/// A time that was assigned as n * interval, or summed up to it within 1e-9 of an interval, counts as reached.
double Schedule::index_after(double t) const { return std::floor(t / interval_ + 1e-9) + 1; }

bool Schedule::due(double t) {
  if (interval_ <= 0) return every_step_;
  const double after = index_after(t);
  if (after <= next_) return false;
  next_ = after;
  return true;
}

double Schedule::next_time(double t) const {
  return interval_ > 0 ? index_after(t) * interval_ : std::numeric_limits<double>::infinity();
}

void Schedule::skip_to(double t) {
  if (interval_ > 0) next_ = index_after(t);
}

}  // namespace bw
