// SPDX-License-Identifier: Apache-2.0
// Surfaces for the tests of the embedded boundary.
#pragma once
#include <cmath>

#include "coupling/surface.h"

namespace bw::cfd::test {

using coupling::WetSurface;

inline void finish(WetSurface& s, int32_t flags = 0, int32_t body = 0) {
  s.v.resize(s.x.size());
  s.body.resize(s.quads.size(), body);
  s.flags.resize(s.quads.size(), flags);
  for (size_t i = s.node_id.size(); i < s.x.size(); ++i) s.node_id.push_back(int64_t(i)), s.node_parent.push_back(-1);
  for (size_t i = s.face_id.size(); i < s.quads.size(); ++i) s.face_id.push_back(int64_t(i));
}

/// Axis-aligned box, m x m quads a side.
inline WetSurface box(const Vec3& lower, const Vec3& upper, int m = 1) {
  WetSurface s;
  for (int d = 0; d < 3; ++d)
    for (int side = 0; side < 2; ++side) {
      const int u = (d + 1) % 3, v = (d + 2) % 3, first = int(s.x.size());
      for (int b = 0; b <= m; ++b)
        for (int a = 0; a <= m; ++a) {
          Vec3 x;
          x[d] = side ? upper[d] : lower[d];
          x[u] = lower[u] + (upper[u] - lower[u]) * a / m;
          x[v] = lower[v] + (upper[v] - lower[v]) * b / m;
          s.x.push_back(x);
        }
      for (int b = 0; b < m; ++b)
        for (int a = 0; a < m; ++a) {
          const int p = first + b * (m + 1) + a, q = p + m + 1;
          if (side)
            s.quads.push_back({p, p + 1, q + 1, q});
          else
            s.quads.push_back({p, q, q + 1, p + 1});
        }
    }
  finish(s);
  return s;
}

/// Sphere as a box blown up, m x m quads on each of six sides.
inline WetSurface sphere(const Vec3& centre, double radius, int m) {
  WetSurface s = box({-1, -1, -1}, {1, 1, 1}, m);
  for (Vec3& x : s.x) {
    const Vec3 t{std::tan(x.x * M_PI / 4), std::tan(x.y * M_PI / 4), std::tan(x.z * M_PI / 4)};
    x = centre + radius * unit(t);
  }
  return s;
}

/// Thin rectangle around `centre` with edge vectors a, b; normal a x b.
inline WetSurface plate(const Vec3& centre, const Vec3& a, const Vec3& b, int m = 1) {
  WetSurface s;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= m; ++i) s.x.push_back(centre + (double(i) / m - 0.5) * a + (double(j) / m - 0.5) * b);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      const int p = j * (m + 1) + i, q = p + m + 1;
      s.quads.push_back({p, p + 1, q + 1, q});
    }
  finish(s, coupling::face_thin);
  return s;
}

inline void append(WetSurface& s, const WetSurface& other) {
  const int32_t first = int32_t(s.x.size());
  s.x.insert(s.x.end(), other.x.begin(), other.x.end());
  s.v.insert(s.v.end(), other.v.begin(), other.v.end());
  for (auto q : other.quads) s.quads.push_back({q[0] + first, q[1] + first, q[2] + first, q[3] + first});
  s.body.insert(s.body.end(), other.body.begin(), other.body.end());
  s.flags.insert(s.flags.end(), other.flags.begin(), other.flags.end());
  finish(s);
}

/// Rotation about a unit axis through a point.
inline void rotate(WetSurface& s, const Vec3& axis, double angle, const Vec3& point = {}) {
  for (Vec3& x : s.x) {
    const Vec3 r = x - point;
    x = point + std::cos(angle) * r + std::sin(angle) * cross(axis, r) + (1 - std::cos(angle)) * dot(axis, r) * axis;
  }
}

inline void set_velocity(WetSurface& s, const Vec3& v) { s.v.assign(s.x.size(), v); }

}  // namespace bw::cfd::test
