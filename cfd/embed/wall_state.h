// SPDX-License-Identifier: Apache-2.0
// Half of a Riemann problem: gas against a wall that moves towards it with dv (> 0: compression). The state at the wall
// has the wall's normal velocity; the wave between it and the gas is
//   a shock,   by the Hugoniot of the stiffened gas with the Gruneisen coefficient and the sound speed of the gas
//   ahead, closed form
//              (exact for an ideal and a stiffened gas),
//   or a fan,  along the isentrope of the equation of state; closed form for ideal and stiffened gases, integrated
//   else; p* >= 0.
// The linear p + rho c dv goes negative on a case that recedes at 1-2 km/s.
#pragma once
#include <algorithm>
#include <cmath>

namespace bw::cfd {

struct WallStar {
  double p;         ///< pressure at the wall [Pa], >= 0
  double compress;  ///< rho*/rho, > 0
};

/// What is left of a gas that cannot follow its wall.
inline constexpr double wall_vacuum = 1e-8;

namespace detail {
/// The stiffened gas with the same G = rho (de/dp)|_rho and rho c^2: gamma = 1 + 1/G, rho c^2 = gamma (p + p_inf).
struct LocalGas {
  double gamma, P, p_inf;
  LocalGas(double p, double rho_c2, double G) : gamma(1 + 1 / G), P(rho_c2 / gamma), p_inf(P - p) {}
};

inline WallStar shock(double rho, double p, double rho_c2, double G, double dv) {
  const LocalGas g(p, rho_c2, G);
  const double a = 2 / ((g.gamma + 1) * rho), k = (g.gamma - 1) / (g.gamma + 1), q = dv * dv / (2 * a);
  const double rise = q + std::sqrt(q * q + (1 + k) * g.P * dv * dv / a);  // Toro 4.6, solved for p* - p
  const double ratio = 1 + rise / g.P;
  return {p + rise, (ratio + k) / (k * ratio + 1)};
}

/// The fan of a stiffened gas: c* = c + (gamma - 1)/2 dv.
inline WallStar fan(double rho, double p, double rho_c2, double G, double dv) {
  const LocalGas g(p, rho_c2, G);
  const double share = std::max(1 + 0.5 * (g.gamma - 1) * dv / std::sqrt(rho_c2 / rho), 0.0);
  const double p_star = g.P * std::pow(share, 2 * g.gamma / (g.gamma - 1)) - g.p_inf;
  if (p_star <= wall_vacuum * p) {  // cavitates
    const double P_end = std::max(g.p_inf / g.P, 0.0);
    return {wall_vacuum * p, std::max(std::pow(P_end, 1 / g.gamma), wall_vacuum)};
  }
  return {p_star, std::pow(share, 2 / (g.gamma - 1))};
}

/// The fan of any equation of state, fourth order in steps of c/2. With gamma = 1 + 1/G, z = (rho*/rho)^((gamma - 1)/2)
/// and Q = p* (rho*/rho)^-gamma:  dz/dv = (gamma - 1)/2 z/c,  dQ/dv = (rho c^2 - gamma p) (rho*/rho)^-gamma/c; z linear
/// and Q constant for an ideal gas. stiffness(r, p) = rho c^2 at rho* = r rho.
template <class Stiffness>
WallStar fan(double rho, double p, double G, double dv, const Stiffness& stiffness) {
  const double gamma = 1 + 1 / G, over_m = 2 / (gamma - 1);
  struct Rate {
    double z, Q, c;
  };
  WallStar now{p, 1};
  // where the equation of state runs out of stiffness a step may overshoot: that gas cavitates
  constexpr double z_least = 1e-6;
  auto rate = [&](double z, double Q) {
    z = std::max(z, z_least);
    const double r = std::pow(z, over_m), r_gamma = r * z * z;
    now = {Q * r_gamma, r};
    const double K = std::max(stiffness(r, now.p), 1e-9 * p), c = std::sqrt(K / (rho * r));
    return Rate{-z / (over_m * c), -(K - gamma * now.p) / (r_gamma * c), c};
  };
  double z = 1, Q = p, left = -dv;
  for (int step = 0; left > 0 && step < 100; ++step) {
    const Rate k1 = rate(z, Q);
    const double d = std::min(left, 0.5 * k1.c), half = 0.5 * d;
    if (d < 0.1 * k1.c && step == 0) {  // a short fan: the midpoint rule is within 1e-4
      const Rate k = rate(z + half * k1.z, Q + half * k1.Q);
      const double z_end = std::max(z + d * k.z, z_least), r = std::pow(z_end, over_m);
      return {std::max((Q + d * k.Q) * r * z_end * z_end, wall_vacuum * p), std::max(r, wall_vacuum)};
    }
    const Rate k2 = rate(z + half * k1.z, Q + half * k1.Q), k3 = rate(z + half * k2.z, Q + half * k2.Q),
               k4 = rate(z + d * k3.z, Q + d * k3.Q);
    z += d / 6 * (k1.z + 2 * k2.z + 2 * k3.z + k4.z);
    Q += d / 6 * (k1.Q + 2 * k2.Q + 2 * k3.Q + k4.Q);
    left -= d;
    if (!(z > z_least) || !std::isfinite(Q)) return {wall_vacuum * p, wall_vacuum};
    const double r = std::pow(z, over_m);
    now = {Q * r * z * z, r};
    if (now.p <= wall_vacuum * p || r <= wall_vacuum) break;
  }
  return {std::max(now.p, wall_vacuum * p), std::max(now.compress, wall_vacuum)};
}
}  // namespace detail

/// rho, p, rho_c2: the gas; G = sum alpha/Gruneisen; ideal: fan() in closed form is exact; stiffness(r, p): rho c^2 on
/// its isentrope.
template <class Stiffness>
WallStar wall_star(double rho, double p, double rho_c2, double G, double dv, bool ideal, const Stiffness& stiffness) {
  if (dv == 0) return {p, 1};
  if (dv > 0) return detail::shock(rho, p, rho_c2, G, dv);
  // a weak fan does not ask which gas it is: the closed form is within 1e-4 of p
  if (ideal || dv * dv * rho < 2.5e-5 * rho_c2) return detail::fan(rho, p, rho_c2, G, dv);
  const WallStar s = detail::fan(rho, p, G, dv, stiffness);
  // where the stiffness collapses on the way (a mixed cell, an explosive in tension) the integration leads nowhere
  return s.p > 0 && s.compress > 0 ? s : detail::fan(rho, p, rho_c2, G, dv);
}

}  // namespace bw::cfd
