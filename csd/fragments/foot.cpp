// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/foot.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bw::csd {

/// Newton's method for the two coordinates in which x - p is perpendicular to the face.
std::optional<Foot> foot_on(const Vec3& x, const std::array<Vec3, 4>& q) {
  constexpr double beside = 1 + 1e-6;  // meshes that match have nodes on edges, to round-off
  const Vec3 twist = 0.25 * (q[0] - q[1] + q[2] - q[3]);
  double s = 0, t = 0, before = 1e300;
  for (int i = 0; i < 12; ++i) {
    const std::array<double, 4> N{0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 + s) * (1 + t),
                                  0.25 * (1 - s) * (1 + t)};
    const Vec3 r = x - (N[0] * q[0] + N[1] * q[1] + N[2] * q[2] + N[3] * q[3]);
    const Vec3 ps = 0.25 * ((1 - t) * (q[1] - q[0]) + (1 + t) * (q[2] - q[3]));
    const Vec3 pt = 0.25 * ((1 - s) * (q[3] - q[0]) + (1 + s) * (q[2] - q[1]));
    const double a = dot(ps, ps), b = dot(ps, pt) - dot(r, twist), c = dot(pt, pt), det = a * c - b * b;
    if (!(det > 1e-12 * a * c)) return std::nullopt;
    const double u = dot(r, ps), v = dot(r, pt), ds = (c * u - b * v) / det, dt = (a * v - b * u) / det;
    if (const double change = std::fabs(ds) + std::fabs(dt); change > 1e-14) {
      s += ds, t += dt;
      const double far = std::max(std::fabs(s), std::fabs(t));
      if (!(far < 4)) return std::nullopt;
      if (change < 0.25 * before && far > beside + 4 * change) return std::nullopt;  // it converges there: beside
      before = change;
      if (i < 11) continue;
      // round-off of coordinates far from the origin, in sizes of the face
      const double noise = 8 * std::numeric_limits<double>::epsilon() * norm(x) / std::sqrt(std::min(a, c));
      if (change > 1e-12 + noise) return std::nullopt;  // as far from the face as it is curved
    }
    if (std::fabs(s) > beside || std::fabs(t) > beside) return std::nullopt;
    const Vec3 area = cross(ps, pt);
    const Vec3 normal = unit(area);
    return Foot{N, normal, dot(r, normal), 2 * std::sqrt(norm(area))};
  }
  return std::nullopt;
}

}  // namespace bw::csd
