// SPDX-License-Identifier: Apache-2.0
// The flux of any gas through an opening narrower than a cell (cfd/embed/orifice.h), in the grid's frame.
#pragma once
#include <algorithm>

#include "cfd/embed/orifice.h"
#include "cfd/embed/wall_gas.h"

namespace bw::cfd {

/// Between the states w[0] below and w[1] above a cell face normal to d, `open` of which is open; it moves with v_wall.
/// lambda: dt/h, which bounds the flow; stored[i]: energy per mass of material 1 still to be released. F: the flux;
/// returned: the velocity of volume.
template <class Eos>
double jet_flux(const WallGas<Eos>& gas, const typename WallGas<Eos>::State (&w)[2], int d, const Vec3& v_wall,
                double open, double lambda, const double (&stored)[2], double (&F)[Eos::Flow::n_flux]) {
  using Gas = WallGas<Eos>;
  using Flow = typename Eos::Flow;
  using State = typename Gas::State;
  double K[2], rest[2];
  for (int i = 0; i < 2; ++i) {
    K[i] = std::max(gas.stiffness(w[i]), 1e-12 * w[i][Gas::p]);
    const double towards = std::max((i ? -1 : 1) * (w[i][size_t(Gas::v + d)] - v_wall[d]), 0.0);
    rest[i] = w[i][Gas::p] + 0.5 * Gas::rho(w[i]) * towards * towards;
  }
  const int from = rest[1] > rest[0] ? 1 : 0;
  const double sign = from ? -1 : 1;
  const State &up = w[from], &other = w[1 - from];
  const Vec3 relative = Gas::velocity(up) - v_wall;
  Jet jet{0, 0, 0.5 * (up[Gas::p] + other[Gas::p])};
  if (const double difference = rest[from] - other[Gas::p]; difference > 0) {
    jet = cfd::jet(Gas::rho(up), up[Gas::p], K[from], gas.eos.G(up), std::max(sign * relative[d], 0.0), other[Gas::p]);
    // a step must not carry more than evens the pressures out
    const double most = 0.5 * difference * Gas::rho(up) / (K[from] * open * lambda);
    if (jet.mass > most) jet.mass = most;
  }
  const double rho = Gas::rho(up), flow = sign * jet.mass, speed = flow / rho;
  const double inner = gas.eos.G(up) * up[Gas::p] + gas.pi(up), own = inner + 0.5 * rho * dot(relative, relative);
  Vec3 momentum = flow * relative;
  momentum[d] = jet.mass * jet.speed + jet.pressure;
  const double energy = flow * (own + up[Gas::p]) / rho;
  // from the wall's frame to that of the grid, which moves across the opening with -v_wall
  const double v_grid = v_wall[d], v = speed + v_grid;
  std::fill(F, F + Flow::n_flux, 0.0);
  for (int k = 0; k < Gas::densities; ++k) F[Cons::arho(k)] = up[size_t(FaceRow::arho(k))] * v;
  const Vec3 v_up = Gas::velocity(up);
  constexpr int mom = Flow::mixed ? int(Cons::mom) : int(GasCons::mom);
  for (int e = 0; e < 3; ++e) F[mom + e] = momentum[e] + flow * v_wall[e] + v_grid * rho * v_up[e];
  constexpr int E = Flow::mixed ? int(Cons::rhoE) : int(GasCons::rhoE);
  F[E] = energy + dot(momentum, v_wall) + 0.5 * flow * dot(v_wall, v_wall) +
         v_grid * (inner + 0.5 * rho * dot(v_up, v_up));
  if constexpr (Flow::mixed) {
    F[Cons::alpha1] = up[Prim::alpha1] * v;
    if constexpr (Flow::materials > 2)
      for (int k = 1; k < Flow::materials; ++k) F[Cons::alpha(k)] = up[size_t(FaceRow::alpha(k))] * v;
    F[E] += F[Cons::arho1] * stored[from];
  }
  return v;
}

}  // namespace bw::cfd
