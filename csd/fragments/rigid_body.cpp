// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/rigid_body.h"

#include <algorithm>
#include <cmath>

namespace bw::csd {

namespace {

/// Turns the body by the midpoint rule over h; P: angular momentum in its frame.
void turn(const Mat3& inverse_inertia, double h, Attitude& q, Vec3& P) {
  Vec3 next = P, angle;
  const double round_off = 1e-16 * norm(P);
  for (int i = 0; i < 50; ++i) {
    angle = h * (inverse_inertia * (0.5 * (P + next)));
    const Vec3 better = Attitude::by(-angle).matrix() * P;
    const double change = norm(better - next);
    next = better;
    if (change <= round_off) break;
  }
  P = next;
  q = q * Attitude::by(angle);
}

}  // namespace

RigidBody::RigidBody(std::vector<NodeId> nodes, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& v,
                     const Field<double, NodeId>& m, Motion motion)
    : motion_(motion), nodes_(std::move(nodes)) {
  const Vec3 origin = x[nodes_.front()];  // far from (0, 0, 0) digits would be lost
  for (NodeId n : nodes_) mass_ += m[n], x_ += m[n] * (x[n] - origin), v_ += m[n] * v[n];
  x_ = origin + x_ / mass_, v_ = v_ / mass_;
  Mat3 inertia;
  for (NodeId n : nodes_) {
    const Vec3 r = x[n] - x_;
    arm_.push_back(r);
    radius_ = std::max(radius_, norm(r));
    if (motion_ == Motion::translation) continue;
    L_ += m[n] * cross(r, v[n] - v_);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inertia(i, j) += m[n] * ((i == j ? dot(r, r) : 0.0) - r[i] * r[j]);
  }
  if (motion_ == Motion::six_dof) inverse_inertia_ = inverse(inertia);
  renew_spin();
}

void RigidBody::renew_spin() { omega_ = turned_ * (inverse_inertia_ * (transpose(turned_) * L_)); }

Vec3 RigidBody::response(const Vec3& at, const Vec3& from, const Vec3& impulse) const {
  const Vec3 turning = turned_ * (inverse_inertia_ * (transpose(turned_) * cross(from, impulse)));
  return impulse / mass_ + cross(turning, at);
}

double RigidBody::kinetic_product(double h) const {
  const double flies = 0.5 * mass_ * dot(v_, v_) - 0.5 * h * h / mass_ * dot(F_, F_);
  if (motion_ == Motion::translation) return flies;
  const Vec3 turning = turned_ * (inverse_inertia_ * (transpose(turned_) * T_));
  return flies + 0.5 * dot(omega_, L_) - 0.5 * h * h * dot(turning, T_);
}

Vec3 RigidBody::acceleration_at(const Vec3& arm) const {
  return F_ / mass_ + cross(turned_ * (inverse_inertia_ * (transpose(turned_) * T_)), arm);
}

void RigidBody::stop() {
  is_stopped_ = true;
  v_ = L_ = omega_ = F_ = T_ = {};
}

void RigidBody::push(const Vec3& arm, const Vec3& impulse) {
  v_ += impulse / mass_;
  if (motion_ == Motion::six_dof) L_ += cross(arm, impulse), renew_spin();
}

void RigidBody::take(const Push& push) {
  F_ = T_ = {};
  if (!is_stopped_) F_ = push.F, T_ = push.T;
}

void RigidBody::take_forces(const Field<Vec3, NodeId>& f) {
  Push push;
  for (size_t i = 0; i < nodes_.size(); ++i) add(arm_[i], f[nodes_[i]], push);
  take(push);
}

void RigidBody::share_forces(const Field<double, NodeId>& m, Field<Vec3, NodeId>& f) const {
  const Vec3 acceleration = F_ / mass_, turning = turned_ * (inverse_inertia_ * (transpose(turned_) * T_));
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const NodeId n = nodes_[i];
    if (is_stopped_)
      f[n] = {};
    else if (motion_ == Motion::translation)
      f[n] = m[n] * acceleration;
    else
      f[n] = m[n] * (acceleration + cross(turning, arm(i)));
  }
}

void RigidBody::kick(double h) {
  v_ += (h / mass_) * F_;
  if (motion_ == Motion::translation || T_ == Vec3{}) return;
  L_ += h * T_;
  renew_spin();
}

bool RigidBody::drift(double dt) {
  x_ += dt * v_;
  if (motion_ == Motion::translation || L_ == Vec3{}) return false;
  static const double p = 1 / (4 - std::cbrt(4.0));  // [Suzuki 1990]
  Vec3 P = transpose(turned_) * L_;
  for (const double part : {p, p, 1 - 4 * p, p, p}) turn(inverse_inertia_, part * dt, q_, P);
  const double size = std::sqrt(q_.w * q_.w + dot(q_.u, q_.u));
  q_ = {q_.w / size, q_.u / size};
  turned_ = q_.matrix();
  renew_spin();
  return true;
}

void RigidBody::place_nodes(Field<Vec3, NodeId>& x) const {
  for (size_t i = 0; i < nodes_.size(); ++i) x[nodes_[i]] = place_of(arm_[i]);
}
void RigidBody::move_nodes(Field<Vec3, NodeId>& v) const {
  for (size_t i = 0; i < nodes_.size(); ++i) v[nodes_[i]] = motion_ == Motion::translation ? v_ : velocity_at(arm(i));
}

}  // namespace bw::csd
