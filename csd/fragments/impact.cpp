// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/impact.h"

#include <algorithm>
#include <cmath>

namespace bw::csd {
namespace {

/// Kinetic energy in a frame that moves with the walls: what an impact must not increase.
double energy_beside(const RigidBody& body, const Vec3& wall) {
  return body.kinetic_energy() - body.mass() * dot(body.velocity() - 0.5 * wall, wall);
}

/// Impulses by sweeps over the points until they settle.
void sweep(RigidBody& body, std::vector<Touch>& touches, double restitution, double friction) {
  constexpr int most = 200;
  for (int k = 0; k < most; ++k) {
    double change = 0, size = 0;
    for (Touch& t : touches) {
      const Vec3& n = t.normal;
      const double before = dot(t.before - t.wall, n), e = restitution * t.restitution;
      const double wanted = before < -t.gap_rate && e > 0 ? -e * before : -t.gap_rate;
      Vec3 v = body.velocity_at(t.arm) - t.wall;
      const double old = dot(t.impulse, n), softness = dot(n, body.response(t.arm, t.arm, n));
      const double now = std::max(0.0, old + (wanted - dot(v, n)) / softness);
      if (now != old) body.push(t.arm, (now - old) * n);
      t.impulse += (now - old) * n;
      change = std::max(change, std::fabs(now - old)), size = std::max(size, now);
      const double limit = friction * t.friction * now;
      const Vec3 held = t.impulse - dot(t.impulse, n) * n;
      if (limit == 0 && held == Vec3{}) continue;
      v = body.velocity_at(t.arm) - t.wall;
      // a bound of the softness along the plane: the trace of what is not along the normal
      double trace = 0;
      for (int d = 0; d < 3; ++d) {
        Vec3 axis{};
        axis[d] = 1;
        trace += body.response(t.arm, t.arm, axis)[d];
      }
      Vec3 wish = held - (1 / (trace - softness)) * (v - dot(v, n) * n);
      if (const double length = norm(wish); length > limit) wish = (limit / length) * wish;
      if (!(wish == held)) body.push(t.arm, wish - held);
      t.impulse += wish - held;
      change = std::max(change, norm(wish - held));
    }
    if (change <= 1e-13 * size) return;
  }
}

}  // namespace

bool resolve(RigidBody& body, std::vector<Touch>& touches) {
  bool reaches = false;
  for (Touch& t : touches) {
    t.before = body.velocity_at(t.arm), t.impulse = {};
    reaches |= dot(t.before - t.wall, t.normal) < -t.gap_rate;
  }
  if (!reaches) return false;
  const RigidBody start = body;
  const Vec3 wall = touches.front().wall;  // of walls that move apart from each other, energy may come in
  bool is_one = true;
  for (const Touch& t : touches) is_one = is_one && t.wall == wall;
  for (const auto& [restitution, friction] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}) {
    body = start;
    for (Touch& t : touches) t.impulse = {};
    sweep(body, touches, restitution, friction);
    const double before = energy_beside(start, wall);
    if (!is_one || energy_beside(body, wall) <= before + 1e-12 * std::fabs(before)) break;
  }
  return true;
}

}  // namespace bw::csd
