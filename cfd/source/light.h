// SPDX-License-Identifier: Apache-2.0
// Where a programmed burn begins besides points, and how much longer than a straight line the way through the explosive
// is.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/math/tensor.h"

namespace bw::cfd {

/// A line of detonation (cord) from `from` to `to` [m], lit all along at once.
struct LineLight {
  Vec3 from, to;
  Vec3 nearest(const Vec3& x) const {
    const Vec3 along = to - from;
    const double length2 = dot(along, along);
    return length2 > 0 ? from + std::clamp(dot(x - from, along) / length2, 0.0, 1.0) * along : from;
  }
};

/// A disc of detonation, or a whole plane [m], lit all over at once; normal of length 1.
struct DiscLight {
  Vec3 centre, normal{0, 0, 1};
  double radius = 1e300;
  Vec3 nearest(const Vec3& x) const {
    const Vec3 in_plane = x - dot(x - centre, normal) * normal, out = in_plane - centre;
    const double r = norm(out);
    return r <= radius ? in_plane : centre + (radius / r) * out;
  }
};

/// How much longer the way through the explosive is than the straight line, on a lattice of points; linear between
/// them.
struct WayTable {
  Vec3 lower, h;                  ///< of the first point, spacing [m]
  std::array<int, 3> n{0, 0, 0};  ///< points
  std::vector<double> longer;     ///< [k][j][i] m
  double most = 0;                ///< the largest of them [m]

  bool empty() const { return longer.empty(); }
  size_t at(int k, int j, int i) const { return (size_t(k) * size_t(n[1]) + size_t(j)) * size_t(n[0]) + size_t(i); }
  double more(const Vec3& x) const {
    int first[3], next[3];
    double share[3];
    for (int d = 0; d < 3; ++d) {
      const double place = std::clamp((x[d] - lower[d]) / h[d], 0.0, double(n[size_t(d)] - 1));
      first[d] = int(place), next[d] = std::min(first[d] + 1, n[size_t(d)] - 1), share[d] = place - first[d];
    }
    double sum = 0;
    for (int c = 0; c < 8; ++c) {
      double weight = 1;
      int i[3];
      for (int d = 0; d < 3; ++d) {
        const bool upper = c >> d & 1;
        weight *= upper ? share[d] : 1 - share[d];
        i[d] = upper ? next[d] : first[d];
      }
      if (weight > 0) sum += weight * longer[at(i[2], i[1], i[0])];
    }
    return sum;
  }
};

}  // namespace bw::cfd
