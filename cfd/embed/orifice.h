// SPDX-License-Identifier: Apache-2.0
// Gas through an opening much narrower than a cell: from the rest pressure of the cell that it leaves, along its
// isentrope, down to the pressure of the other or to the speed of sound [Shapiro, The dynamics and thermodynamics of
// compressible fluid flow, 4]. The jet is narrower than a sharp-edged opening: by 0.61 for a small difference of
// pressure [Kirchhoff: pi/(pi + 2)] to 0.84 into a vacuum [Perry, Trans. ASME 71 (1949) 757].
#pragma once
#include <algorithm>
#include <cmath>

#include "cfd/embed/wall_state.h"

namespace bw::cfd {

/// Per area of the opening, relative to the wall; all >= 0.
struct Jet {
  double mass = 0;      ///< kg/(m^2 s)
  double speed = 0;     ///< m/s, of the jet
  double pressure = 0;  ///< Pa, in it
};

/// rho, p, rho_c2, G: gas that leaves (G = 1/Gruneisen); approach [m/s]: its speed towards the opening, >= 0; p_other <
/// p.
inline Jet jet(double rho, double p, double rho_c2, double G, double approach, double p_other) {
  const detail::LocalGas g(p, rho_c2, G);
  const double m = g.gamma - 1, up = g.gamma / m, c2 = rho_c2 / rho;
  const double rest = 1 + 0.5 * m * approach * approach / c2;
  const double P0 = g.P * std::pow(rest, up), rho0 = rho * std::pow(rest, 1 / m), c02 = c2 * rest;
  const double other = std::clamp((p_other + g.p_inf) / P0, 0.0, 1.0);
  const double ratio = std::max(other, std::pow(2 / (g.gamma + 1), up));
  const double speed = std::sqrt(std::max(2 / m * c02 * (1 - std::pow(ratio, 1 / up)), 0.0));
  const double narrowing = 0.84 - 0.23 * other * other;
  return {narrowing * rho0 * std::pow(ratio, 1 / g.gamma) * speed, speed, ratio * P0 - g.p_inf};
}

}  // namespace bw::cfd
