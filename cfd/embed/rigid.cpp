// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/rigid.h"

#include <cmath>

#include "cfd/embed/scan.h"

namespace bw::cfd {
namespace {

Mat3 outer(const Vec3& a, const Vec3& b) { return {{a.x * b, a.y * b, a.z * b}}; }

}  // namespace

MassProperties solid_of(const std::vector<Vec3>& X, const std::vector<std::array<int32_t, 4>>& quads) {
  MassProperties r;
  if (X.empty()) return r;
  const Vec3 o = X[0];  // a point near by: tetrahedra from it have no great volumes that cancel
  Vec3 first;
  Mat3 second{};
  for (const auto& q : quads)
    for_each_triangle(X, q, [&](const Vec3& pa, const Vec3& pb, const Vec3& pc, int, int) {
      const Vec3 a = pa - o, b = pb - o, c = pc - o, sum = a + b + c;
      const double volume = triple(a, b, c) / 6;
      r.mass += volume;
      first += 0.25 * volume * sum;
      second = second + (volume / 20) * (outer(a, a) + outer(b, b) + outer(c, c) + outer(sum, sum));
    });
  if (!(r.mass > 0)) return r;
  const Vec3 centre = first / r.mass;
  second = second - r.mass * outer(centre, centre);
  r.centre = o + centre;
  r.inertia = trace(second) * Mat3::identity() - second;
  return r;
}

RigidBody::RigidBody(const MassProperties& mass, const std::array<bool, 6>& free, const Vec3& velocity,
                     const Vec3& spin)
    : mass_(mass), free_(free) {
  s_.velocity = velocity;
  s_.spin_momentum = freed(mass.inertia * spin, 3);
}

Vec3 RigidBody::freed(const Vec3& a, int first) const {
  Vec3 r;
  for (int d = 0; d < 3; ++d) r[d] = free_[size_t(first + d)] ? a[d] : 0.0;
  return r;
}

Mat3 RigidBody::inverse_inertia(const Attitude& turn) const {
  const Mat3 R = turn.matrix();
  Mat3 I = turn.none() ? mass_.inertia : R * mass_.inertia * transpose(R);
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 3; ++e)
      if (!free_[size_t(3 + d)] || !free_[size_t(3 + e)]) I(d, e) = d == e ? 1 : 0;
  Mat3 inv = inverse(I);
  for (int d = 0; d < 3; ++d)
    if (!free_[size_t(3 + d)]) inv(d, d) = 0;
  return inv;
}

Vec3 RigidBody::turn_angle(double dt) const {
  if (!free_[3] && !free_[4] && !free_[5]) return {};
  const Attitude half = s_.place.turn.further(0.5 * dt * spin());
  return s_.turn_gap + dt * (inverse_inertia(half) * (s_.spin_momentum + 0.5 * dt * freed(s_.moment, 3)));
}

RigidBody::Place RigidBody::after(double dt) const {
  const Vec3 a = freed(s_.force, 0) / mass_.mass;
  return {s_.place.shift + s_.gap + dt * (s_.velocity + 0.5 * dt * a), s_.place.turn.further(turn_angle(dt))};
}

RigidBody::Place RigidBody::halfway(double dt) const {
  const Place end = after(dt);
  return {0.5 * (s_.place.shift + end.shift), s_.place.turn.further(0.5 * turn_angle(dt))};
}

Vec3 RigidBody::position(const Vec3& X, const Place& at) const {
  if (at.turn.none()) return X + at.shift;
  return mass_.centre + at.turn.matrix() * (X - mass_.centre) + at.shift;
}

void RigidBody::advance(double dt, const Vec3& force, const Vec3& moment, double work) {
  const Place end = after(dt);
  const Mat3 inv = inverse_inertia(halfway(dt).turn);
  s_.gap = (0.5 * dt * dt / mass_.mass) * freed(force - s_.force, 0);
  s_.turn_gap = 0.5 * dt * dt * (inv * freed(moment - s_.moment, 3));
  s_.place = end;
  s_.velocity += (dt / mass_.mass) * freed(force, 0);
  s_.spin_momentum += dt * freed(moment, 3);
  s_.force = force, s_.moment = moment;
  s_.impulse += dt * force, s_.twist += dt * moment;
  s_.work += work;
}

double RigidBody::kinetic_energy() const {
  return 0.5 * mass_.mass * dot(s_.velocity, s_.velocity) + 0.5 * dot(s_.spin_momentum, spin());
}

}  // namespace bw::cfd
