// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bw::cfd {

Vec3 Placement::operator()(const Vec3& X) const {
  if (angle == 0) return X + shift;
  const Vec3 r = X - point, a = unit(axis);
  return point + std::cos(angle) * r + std::sin(angle) * cross(a, r) + (1 - std::cos(angle)) * dot(a, r) * a + shift;
}

Placement TableMotion::at(double t) const {
  Vec3 d;
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    if (t <= times[i]) return {d, {}, {0, 0, 1}, 0};
    const double s = std::min(1.0, (t - times[i]) / (times[i + 1] - times[i])), dt = s * (times[i + 1] - times[i]);
    d += dt * (velocities[i] + 0.5 * s * (velocities[i + 1] - velocities[i]));
  }
  d += std::max(t - times.back(), 0.0) * velocities.back();
  return {d, {}, {0, 0, 1}, 0};
}

Placement PulseMotion::at(double t) const {
  const double s = std::clamp(t - start, 0.0, duration), w = 2 * std::numbers::pi / duration;
  return {(0.5 * s - 0.5 / w * std::sin(w * s)) * velocity, {}, {0, 0, 1}, 0};
}

Placement OscillationMotion::at(double t) const {
  const double w = 2 * std::numbers::pi * frequency;
  return {((1 - std::cos(w * t)) / w) * velocity, {}, {0, 0, 1}, 0};
}

Bodies::Bodies(const std::vector<BodyCase>& bodies, const ShapeSetting& setting) : setting_(setting) {
  for (size_t b = 0; b < bodies.size(); ++b) {
    const BodyCase& body = bodies[b];
    ShapeSetting wanted = setting;
    if (body.facet > 0) wanted.h = body.facet;
    const Facets f = std::visit([&](const auto& s) { return s.facets(wanted); }, body.shape);
    const bool thin = body.thin || std::holds_alternative<PlaneShape>(body.shape);
    const int32_t first = int32_t(X_.size());
    const Placement turned{{}, body.turn_point, body.turn_axis, body.turn_angle * std::numbers::pi / 180};
    for (const Vec3& x : f.x) {
      X_.push_back(turned(x));
      body_of_.push_back(int32_t(b));
    }
    for (const auto& q : f.quads) {
      surface_.quads.push_back({q[0] + first, q[1] + first, q[2] + first, q[3] + first});
      surface_.body.push_back(int32_t(b));
      surface_.flags.push_back(thin ? int32_t(coupling::face_thin) : 0);
      surface_.face_id.push_back(int64_t(surface_.face_id.size()));
    }
    motion_.push_back(body.motion);
    free_of_.push_back(-1);
    if (const auto* free = std::get_if<FreeMotion>(&body.motion))
      add_free(body, *free, int32_t(surface_.quads.size() - f.quads.size()));
    fixed_ = fixed_ && std::holds_alternative<FixedMotion>(body.motion);
  }
  for (size_t i = 0; i < X_.size(); ++i) surface_.node_id.push_back(int64_t(i));
  surface_.node_parent.assign(X_.size(), -1);
  surface_.v.assign(X_.size(), {});
  surface_.topo_version = 1;
}

std::vector<Vec3> Bodies::positions(double t, double dt) const {
  std::vector<Placement> place(motion_.size());
  std::vector<RigidBody::Place> free;
  for (size_t b = 0; b < motion_.size(); ++b)
    std::visit(
        [&](const auto& motion) {
          if constexpr (requires { motion.at(t); }) place[b] = motion.at(t + dt);
        },
        motion_[b]);
  for (const FreeBody& f : free_) free.push_back(dt > 0 ? f.rigid.after(dt) : f.rigid.place());
  std::vector<Vec3> x(X_.size());
  for (size_t i = 0; i < x.size(); ++i) {
    const size_t b = size_t(body_of_[i]);
    const int32_t f = free_of_[b];
    x[i] = f < 0 ? place[b](X_[i]) : free_[size_t(f)].rigid.position(X_[i], free[size_t(f)]);
  }
  return x;
}

const coupling::WetSurface& Bodies::at(double t) {
  surface_.x = positions(t);
  return surface_;
}

}  // namespace bw::cfd
