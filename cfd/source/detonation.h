// SPDX-License-Identifier: Apache-2.0
// The Chapman-Jouguet state of a JWL set, and the energy that its explosive sets free in a run.
#pragma once
#include <cmath>

#include "cfd/eos/jwl.h"

namespace bw::cfd {

/// V = rho0/rho; u: velocity of the products behind the front; c: their speed of sound.
struct CjState {
  double V = 0, D = 0, p = 0, u = 0, c = 0;
};

/// The tangent of the detonation's Hugoniot and Rayleigh line: the least D = sqrt(p/(rho0 (1 - V))) over V, with
/// p(V) = (f + omega E0/V)/(1 - omega (1 - V)/(2 V)),  f: the set's pressure at no energy.
inline CjState cj_state(const Jwl& m) {
  const auto p_of = [&](double V) {
    const double f = m.A * (1 - m.omega / (m.R1 * V)) * std::exp(-m.R1 * V) +
                     m.B * (1 - m.omega / (m.R2 * V)) * std::exp(-m.R2 * V);
    return (f + m.omega * m.E0 / V) / (1 - m.omega * (1 - V) / (2 * V));
  };
  const auto D2_of = [&](double V) { return p_of(V) / (m.rho0 * (1 - V)); };
  double a = 0.4, b = 0.98;
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double x = b - golden * (b - a), y = a + golden * (b - a), fx = D2_of(x), fy = D2_of(y);
  for (int i = 0; i < 80; ++i) {
    if (fx < fy)
      b = y, y = x, fy = fx, x = b - golden * (b - a), fx = D2_of(x);
    else
      a = x, x = y, fx = fy, y = a + golden * (b - a), fy = D2_of(y);
  }
  CjState s;
  s.V = 0.5 * (a + b);
  s.D = std::sqrt(D2_of(s.V));
  s.p = p_of(s.V);
  s.u = s.D * (1 - s.V);
  s.c = s.D * s.V;
  return s;
}

/// e(rho0, p0) of the products' equation of state [J/kg]: the unburnt explosive at rest. Far below zero (DESIGN 5b).
inline double unburnt_energy(Jwl m, double p0) {
  m.e_shift = 0;
  return internal_energy(m, m.rho0, p0);
}
/// Energy per mass that the burn adds: from the unburnt state at p0 to the set's own E0.
inline double released_energy(const Jwl& m, double p0) { return m.E0 / m.rho0 - unburnt_energy(m, p0); }

}  // namespace bw::cfd
