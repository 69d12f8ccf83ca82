// SPDX-License-Identifier: Apache-2.0
// Pressure on faces as nodal forces, at current positions (follower load).
#pragma once
#include <array>

#include "csd/element/hex.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

inline Vec3 centre_of(const std::array<Vec3, 4>& x) { return 0.25 * (x[0] + x[1] + x[2] + x[3]); }

/// Integrals of N_a n dA over a bilinear quad, n outward for a face of mesh.h's order [m^2]: with x = .. + s A + t B +
/// s t C the area vector is A x B + s A x C + t C x B, and its product with N_a is integrated exactly. They are the
/// derivatives of the enclosed volume by the nodes, so that p V is the potential of a constant pressure.
inline std::array<Vec3, 4> area_shares(const std::array<Vec3, 4>& x) {
  const Vec3 lower = x[1] - x[0], upper = x[2] - x[3];
  const Vec3 A = 0.25 * (lower + upper), B = 0.25 * ((x[3] - x[0]) + (x[2] - x[1])), C = 0.25 * (upper - lower);
  const Vec3 mean = cross(A, B), by_s = (1.0 / 3) * cross(A, C), by_t = (1.0 / 3) * cross(C, B);
  return {mean - by_s - by_t, mean + by_s - by_t, mean + by_s + by_t, mean - by_s + by_t};
}

/// Adds the forces of the pressure p > 0 (compression positive: the one place in csd where a pressure becomes a force,
/// with its minus sign) on a face; force(a): that of corner a so far [N].
template <class Force>
void add_pressure(const std::array<Vec3, 4>& x, double p, const Force& force) {
  const auto share = area_shares(x);
  for (size_t a = 0; a < 4; ++a) force(a) -= p * share[a];
}

}  // namespace bw::csd
