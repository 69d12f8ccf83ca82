// SPDX-License-Identifier: Apache-2.0
// Geometry of one trilinear hexahedron: volume, Jacobians, quality.
#pragma once
#include <algorithm>
#include <array>

#include "csd/mesh/mesh.h"

namespace bw::csd {

using HexCorners = std::array<Vec3, 8>;

/// Signs of the parent coordinates (xi, eta, zeta) of the eight nodes.
inline constexpr int hex_sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                       {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
/// The three nodes joined to a corner by edges, ordered so that a right-handed hex gives positive corner Jacobians.
inline constexpr int hex_corner[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                         {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
inline constexpr int hex_edge[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                        {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

/// Node of the hex that the edge from `node` leads to when it leaves the face `side` (jp of eq (16)); `node` lies on
/// the face.
inline constexpr int across(int side, int node) {
  constexpr int mirror[3][8] = {{1, 0, 3, 2, 5, 4, 7, 6}, {3, 2, 1, 0, 7, 6, 5, 4}, {4, 5, 6, 7, 0, 1, 2, 3}};
  return mirror[side / 2][node];
}

template <class Positions>
HexCorners corners(const std::array<NodeId, 8>& hex, const Positions& x) {
  HexCorners c;
  for (int a = 0; a < 8; ++a) c[size_t(a)] = x[hex[size_t(a)]];
  return c;
}

/// Determinant of d(x)/d(xi) at the parent point (xi, eta, zeta).
inline double hex_jacobian(const HexCorners& c, double xi, double eta, double zeta) {
  Vec3 g[3];
  for (int a = 0; a < 8; ++a) {
    const double sx = hex_sign[a][0], sy = hex_sign[a][1], sz = hex_sign[a][2];
    const double fx = 1 + sx * xi, fy = 1 + sy * eta, fz = 1 + sz * zeta;
    g[0] += (0.125 * sx * fy * fz) * c[size_t(a)];
    g[1] += (0.125 * sy * fx * fz) * c[size_t(a)];
    g[2] += (0.125 * sz * fx * fy) * c[size_t(a)];
  }
  return triple(g[0], g[1], g[2]);
}

/// Exact volume of the trilinear hex, and the smallest Jacobian over its 2x2x2 points: the eight weights are 1.
struct HexVolume {
  double volume = 0, min_jacobian = 0;
};
inline HexVolume hex_volume(const HexCorners& c) {
  constexpr double q = 0.57735026918962576451;
  HexVolume v{0, 1e300};
  for (const auto& s : hex_sign) {
    const double jacobian = hex_jacobian(c, q * s[0], q * s[1], q * s[2]);
    v.volume += jacobian;
    v.min_jacobian = std::min(v.min_jacobian, jacobian);
  }
  return v;
}

/// Smallest over the corners of det(unit edge vectors): 1 for a brick, <= 0 for an inverted corner.
inline double scaled_jacobian(const HexCorners& c) {
  double worst = 1e300;
  for (int a = 0; a < 8; ++a) {
    const Vec3 e0 = c[size_t(hex_corner[a][0])] - c[size_t(a)], e1 = c[size_t(hex_corner[a][1])] - c[size_t(a)],
               e2 = c[size_t(hex_corner[a][2])] - c[size_t(a)];
    const double lengths = norm(e0) * norm(e1) * norm(e2);
    worst = std::min(worst, lengths > 0 ? triple(e0, e1, e2) / lengths : 0.0);
  }
  return worst;
}

inline Vec3 centroid(const HexCorners& c) {
  Vec3 sum;
  for (const Vec3& p : c) sum += p;
  return 0.125 * sum;
}

/// Volume of the cone from the origin over a bilinear quad: summed over a closed surface with outward normals, the
/// enclosed volume of the bilinear patches exactly (a hex's faces are such patches).
inline double cone_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (triple(a, b, c) + triple(a, c, d) + triple(a, b, d) + triple(b, c, d)) / 12.0;
}

}  // namespace bw::csd
