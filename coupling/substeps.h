// SPDX-License-Identifier: Apache-2.0
// Equal substeps of the solid inside a window: no drift, no slivers.
#pragma once
#include <cmath>

namespace bw::coupling {

/// while (!sub.done()) { const double h = sub.next(dt_stable); ...step...; t = sub.advance(); }
/// n = ceil((t1 - t0) / dt_stable) equal substeps; if the stable step falls below the present one, the rest of the
/// window is divided anew.
class EqualSubsteps {
 public:
  EqualSubsteps() : EqualSubsteps(0, 0) {}
  EqualSubsteps(double t0, double t1) : start_(t0), t_(t0), t1_(t1) {}
  bool done() const { return t_ >= t1_; }
  double t() const { return t_; }

  /// Length of the next substep, at most dt_stable (> 0) up to round-off.
  double next(double dt_stable) {
    const double tolerance = 1 + 1e-12;  // (t1 - t0) / dt that is whole but for round-off
    if (left_ == 0 || h_ > dt_stable * tolerance) {
      start_ = t_;
      n_ = left_ = std::fmax(1, std::ceil((t1_ - t_) / (dt_stable * tolerance)));
      h_ = (t1_ - start_) / n_;
    }
    return h_;
  }
  /// Time after that substep: exactly t1 at the end.
  double advance() {
    left_ -= 1;
    t_ = left_ == 0 ? t1_ : start_ + (n_ - left_) * h_;
    return t_;
  }

 private:
  double start_, t_, t1_, h_ = 0;
  double n_ = 0, left_ = 0;  // counts, as doubles: a hopeless dt_stable must not overflow
};

}  // namespace bw::coupling
