// SPDX-License-Identifier: Apache-2.0
// The fluid's steps through one window of a coupled run.
#pragma once
#include <functional>

#include "cfd/step.h"

namespace bw::cfd {

/// A step that a window may ask for: from t towards `next`, as far as the Courant number lets it [s].
using WantedStep = std::function<double(double t, double next)>;

struct Stepped {
  coupling::Loads loads;
  double dt = 0;  ///< s, what the walls went for; t1 - t0 but for round-off
};

/// One step; with window.fixed as many as it takes to t1_max, while the walls go on straight lines over the whole of
/// it. next_output(t) [s]: no step passes it; after_step() sees the state after each but the last. Loads are the means
/// over the steps (mean_pressure), or those of the last one; t1 is set, the totals of the faces' work are the caller's.
Stepped window_steps(Model& m, Sweep& sweep, Books& books, const WallMotion& walls, const coupling::Window& window,
                     const WantedStep& wanted, const std::function<double(double)>& next_output,
                     const std::function<void()>& after_step);

}  // namespace bw::cfd
