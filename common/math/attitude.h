// SPDX-License-Identifier: Apache-2.0
// How a rigid body is turned.
#pragma once
#include <cmath>

#include "common/math/tensor.h"

namespace bw {

/// Unit quaternion w + u.
struct Attitude {
  double w = 1;
  Vec3 u{};

  bool none() const { return w == 1 && u == Vec3{}; }
  /// Rotation vector [rad].
  static Attitude by(const Vec3& angle) {
    const double a = norm(angle);
    if (a == 0) return {};
    return {std::cos(0.5 * a), (std::sin(0.5 * a) / a) * angle};
  }
  /// Turned by b first, then by a.
  friend Attitude operator*(const Attitude& a, const Attitude& b) {
    return {a.w * b.w - dot(a.u, b.u), a.w * b.u + b.w * a.u + cross(a.u, b.u)};
  }
  /// First turned so, then by the vector `angle` [rad]; a unit again.
  Attitude further(const Vec3& angle) const {
    if (angle == Vec3{}) return *this;
    Attitude r = by(angle) * *this;
    const double size = std::sqrt(r.w * r.w + dot(r.u, r.u));
    r.w /= size, r.u = r.u / size;
    return r;
  }
  Mat3 matrix() const {
    const double xx = u.x * u.x, yy = u.y * u.y, zz = u.z * u.z;
    return {{{1 - 2 * (yy + zz), 2 * (u.x * u.y - w * u.z), 2 * (u.x * u.z + w * u.y)},
             {2 * (u.x * u.y + w * u.z), 1 - 2 * (xx + zz), 2 * (u.y * u.z - w * u.x)},
             {2 * (u.x * u.z - w * u.y), 2 * (u.y * u.z + w * u.x), 1 - 2 * (xx + yy)}}};
  }
};

}  // namespace bw
