// SPDX-License-Identifier: Apache-2.0
// Volumes that a box shares with a ball or a cylinder around the origin, in closed form: the parts of a ball in the
// cells of a grid add up to the ball.
#pragma once
#include <algorithm>
#include <cmath>

#include "common/math/tensor.h"

namespace bw::cfd {

namespace overlap {

/// Where a line at distance a from the centre leaves the circle of radius s; 0 if it does not meet it.
inline double chord(double a, double s) { return a < s ? std::sqrt((s - a) * (s + a)) : 0; }

/// A quarter of the disc of radius s, cut at x = a and y = b: the angles between which its edge is the circle. Below
/// `from` the edge is x = a up to y = along_a, above `to` it is y = b up to x = along_b. No arc cosines: they lose half
/// the digits where the line touches the circle.
struct Quarter {
  double from, to, along_a, along_b;
  bool whole;  ///< no circle: the corner lies inside
};
inline Quarter quarter(double a, double b, double s) {
  if (a * a + b * b <= s * s) {
    const double diagonal = std::atan2(b, a);
    return {diagonal, diagonal, b, a, true};
  }
  const double y = chord(a, s), x = chord(b, s);
  return {std::atan2(y, a), 0.5 * M_PI - std::atan2(x, b), y, x, false};
}

/// Area of [0, a] x [0, b] in the disc of radius s.
inline double rectangle(double a, double b, double s) {
  if (s <= 0 || a <= 0 || b <= 0) return 0;
  const Quarter q = quarter(std::min(a, s), std::min(b, s), s);
  return q.whole ? a * b : 0.5 * (std::min(a, s) * q.along_a + std::min(b, s) * q.along_b + s * s * (q.to - q.from));
}

/// Integral of (R^2 - a^2/cos^2)^(3/2) over angles from 0 to that whose tangent is y/a; w^2 = R^2 - a^2 - y^2.
inline double power_integral(double a, double y, double w, double R) {
  if (y <= 0) return 0;
  const double k2 = (R - a) * (R + a);
  return R * R * R * std::atan2(R * y, a * w) - a * ((R * R + 0.5 * k2) * std::atan2(y, w) + 0.5 * y * w);
}

/// Integral of sqrt(R^2 - x^2 - y^2) over the part of [0, a] x [0, b] in the disc of radius s; rim^2 = R^2 - s^2.
inline double dome(double a, double b, double s, double rim, double R) {
  if (s <= 0 || a <= 0 || b <= 0) return 0;
  a = std::min(a, s), b = std::min(b, s);
  const Quarter q = quarter(a, b, s);
  const double R3 = R * R * R, w = q.whole ? std::sqrt(std::max(0.0, R * R - a * a - b * b)) : rim;
  const double below = R3 * q.from - power_integral(a, q.along_a, w, R);
  const double above = R3 * (0.5 * M_PI - q.to) - power_integral(b, q.along_b, w, R);
  return (below + above + (q.whole ? 0.0 : (q.to - q.from) * (R3 - rim * rim * rim))) / 3;
}

/// Volume of [0, a] x [0, b] x [0, c] in the ball of radius R.
inline double corner(double a, double b, double c, double R) {
  a = std::min(a, R), b = std::min(b, R), c = std::min(c, R);
  if (a <= 0 || b <= 0 || c <= 0) return 0;
  if (a * a + b * b + c * c <= R * R) return a * b * c;
  const double flat = chord(c, R);  // within it the box ends below the ball
  return c * rectangle(a, b, flat) + dome(a, b, R, 0, R) - dome(a, b, flat, c, R);
}

}  // namespace overlap

/// Volume of the box in the ball of radius R around the origin [m^3].
inline double box_in_ball(const Vec3& lower, const Vec3& upper, double R) {
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const Vec3 x{c & 1 ? upper.x : lower.x, c & 2 ? upper.y : lower.y, c & 4 ? upper.z : lower.z};
    double part = overlap::corner(std::abs(x.x), std::abs(x.y), std::abs(x.z), R);
    for (int d = 0; d < 3; ++d)
      if ((x[d] < 0) == bool(c >> d & 1)) part = -part;  // odd in each coordinate, and lower ends are taken off
    sum += part;
  }
  return sum;
}

/// Area of the rectangle [x lower, x upper] x [y lower, y upper] in the disc of radius R around the origin [m^2].
inline double rectangle_in_disc(const double (&lower)[2], const double (&upper)[2], double R) {
  double sum = 0;
  for (int c = 0; c < 4; ++c) {
    const double x[2] = {c & 1 ? upper[0] : lower[0], c & 2 ? upper[1] : lower[1]};
    double part = overlap::rectangle(std::abs(x[0]), std::abs(x[1]), R);
    for (int d = 0; d < 2; ++d)
      if ((x[d] < 0) == bool(c >> d & 1)) part = -part;
    sum += part;
  }
  return sum;
}

}  // namespace bw::cfd
