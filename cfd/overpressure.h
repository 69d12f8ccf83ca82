// SPDX-License-Identifier: Apache-2.0
// What a blast wave is measured by at a point, kept step by step: overpressure above the pressure there at the start,
// its peak and integrals. Steps are joined linearly.
#pragma once
#include <algorithm>

namespace bw::cfd {

/// Plain data: it is written to checkpoints as it is.
struct Overpressure {
  double p0 = 0;                ///< Pa, at the start
  double now = 0;               ///< Pa above p0 at the last step
  double peak = 0;              ///< Pa, largest so far, at least 0
  double t_peak = 0;            ///< s
  double impulse = 0;           ///< Pa s, integral since the start
  double arrival = -1;          ///< s, first passing of the threshold; -1: not yet
  double end = -1;              ///< s, when it was back at zero after that; -1: not yet
  double positive_impulse = 0;  ///< Pa s, integral from zero before the arrival to zero after it

  void begin(double p) { p0 = p; }
  /// p at t1, a step after t0. threshold [Pa]: what counts as an arrival.
  void add(double t0, double t1, double p, double threshold) {
    const double next = p - p0, dt = t1 - t0, area = 0.5 * dt * (now + next);
    impulse += area;
    if (arrival < 0) {
      if (next >= threshold) arrival = now < threshold ? t0 + dt * (threshold - now) / (next - now) : t0;
      if (next > 0)
        positive_impulse = now > 0 ? positive_impulse + area : 0.5 * dt * next * next / (next - now);
      else
        positive_impulse = 0;
    } else if (end < 0) {
      if (next > 0) {
        positive_impulse += area;
      } else {
        const double share = now / (now - next);  // now > 0 here
        end = t0 + share * dt;
        positive_impulse += 0.5 * share * dt * now;
      }
    }
    if (next > peak) peak = next, t_peak = t1;
    now = next;
  }
  double duration() const { return arrival >= 0 && end >= 0 ? end - arrival : -1; }
};

}  // namespace bw::cfd
