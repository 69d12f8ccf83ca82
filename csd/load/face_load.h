// SPDX-License-Identifier: Apache-2.0
// Pressure on faces as nodal forces, at current positions (follower load).
#pragma once
#include <array>

#include "csd/element/hex.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

inline Vec3 centre_of(const std::array<Vec3, 4>& x) { return 0.25 * (x[0] + x[1] + x[2] + x[3]); }

/// Integrals of N_a n dA over a bilinear quad (2x2 points are exact), n outward for a face of mesh.h's order [m^2].
/// They are the derivatives of the enclosed volume by the nodes, so that p V is the potential of a constant pressure.
inline std::array<Vec3, 4> area_shares(const std::array<Vec3, 4>& x) {
  std::array<Vec3, 4> share{};
  for (int g = 0; g < 4; ++g) {
    const double s = g & 1 ? gauss : -gauss, t = g & 2 ? gauss : -gauss;
    const double N[4] = {0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 + s) * (1 + t),
                         0.25 * (1 - s) * (1 + t)};
    const Vec3 ds = 0.25 * ((1 - t) * (x[1] - x[0]) + (1 + t) * (x[2] - x[3]));
    const Vec3 dt = 0.25 * ((1 - s) * (x[3] - x[0]) + (1 + s) * (x[2] - x[1]));
    const Vec3 dA = cross(ds, dt);
    for (size_t a = 0; a < 4; ++a) share[a] += N[a] * dA;
  }
  return share;
}

/// Adds the forces of the pressure p > 0 (compression positive: the one place in csd where a pressure becomes a force,
/// with its minus sign) on a face.
inline void add_pressure(const std::array<NodeId, 4>& nodes, const std::array<Vec3, 4>& x, double p,
                         Field<Vec3, NodeId>& f) {
  const auto share = area_shares(x);
  for (size_t a = 0; a < 4; ++a) f[nodes[a]] -= p * share[a];
}

}  // namespace bw::csd
