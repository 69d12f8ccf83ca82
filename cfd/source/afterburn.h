// SPDX-License-Identifier: Apache-2.0
// Products of detonation that burn on: further energy per mass of explosive, released at the same pace in all of it,
//   dE/dt = alpha1 rho1 energy dlambda/dt.
// constant:  dlambda/dt the same from begin, or from the start of the run, to the end;
// miller:    dlambda/dt = rate (1 - lambda)^m (p/1 Mbar)^n  [Miller 1995, Mat. Res. Soc. Proc. 418, 413], with the mass
//            mean of p over the products in place of each particle's own: with n = 1/6 a factor of 10 in p is one
//            of 1.5.
// The explosive is material 1.
#pragma once
#include <algorithm>
#include <cmath>

namespace bw::cfd {

struct Afterburn {
  enum class Kind { constant, miller };
  Kind kind = Kind::constant;
  double energy = 0;                       ///< J/kg of explosive
  double begin = 0, end = 0;               ///< s; end: of the constant rate
  double rate = 0;                         ///< 1/s at 1 Mbar and lambda = 0
  double m = 0.5, n = 1.0 / 6;             ///< exponents of what is left and of the pressure
  double least_pressure = 0;               ///< Pa; below it the rate is 0
  double share = 0;                        ///< lambda at the start of the step
  static constexpr double megabar = 1e11;  ///< Pa

  bool needs_pressure(double t1) const { return kind == Kind::miller && t1 > begin && share < 1; }

  /// lambda at t1; p: mean pressure of the products at t0, for miller.
  double share_at(double t0, double t1, double p) const {
    if (t1 <= begin) return share;
    if (kind == Kind::constant) {  // what is left by then, at one pace until the end
      const double from = std::max(t0, begin);
      return t1 >= end ? 1 : share + (1 - share) * (t1 - from) / (end - from);
    }
    if (p < least_pressure || p <= 0 || share >= 1) return share;
    const double advance = rate * std::pow(p / megabar, n) * (t1 - std::max(t0, begin));
    // exact for a pressure that stays: integral of d(left)/left^m
    const double left = 1 - share;
    if (m == 1) return 1 - left * std::exp(-advance);
    const double power = std::pow(left, 1 - m) - (1 - m) * advance;
    return m < 1 ? 1 - std::pow(std::max(power, 0.0), 1 / (1 - m)) : 1 - std::pow(power, 1 / (1 - m));
  }
};

}  // namespace bw::cfd
