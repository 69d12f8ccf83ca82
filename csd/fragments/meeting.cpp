// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/meeting.h"

#include <algorithm>
#include <cmath>

namespace bw::csd {

Vec3 Meeting::velocity(const State& s) const {
  Vec3 u;
  for (size_t i = size_t(first); i < size_t(last); ++i) u += weight[i] * s.v[nodes[i]];
  if (body[0]) u += body[0]->velocity_at(arm[0]);
  if (body[1]) u -= body[1]->velocity_at(arm[1]);
  return u;
}

Vec3 Meeting::response(const State& s, const Supports& held, const Vec3& J) const {
  Vec3 du;
  for (size_t i = size_t(first); i < size_t(last); ++i)
    du += (weight[i] * weight[i] / s.m[nodes[i]]) * held.of(nodes[i], J);
  for (size_t k = 0; k < 2; ++k)
    if (body[k]) du += body[k]->response(arm[k], arm[k], J);
  return du;
}

void Meeting::push(State& s, const Supports& held, const Vec3& J) const {
  for (size_t i = size_t(first); i < size_t(last); ++i)
    s.v[nodes[i]] += (weight[i] / s.m[nodes[i]]) * held.of(nodes[i], J);
  if (body[0]) body[0]->push(arm[0], J);
  if (body[1]) body[1]->push(arm[1], -J);
}

void begin(Meeting& m, const State& s, const Supports& held, double dt, double restitution) {
  m.before = m.velocity(s), m.kicked = m.supported = m.impulse = {};
  for (size_t i = size_t(m.first); i < size_t(m.last); ++i) {
    const NodeId n = m.nodes[i];
    m.kicked += (0.5 * dt * m.weight[i] / s.m[n]) * s.f[n];
    m.supported += m.weight[i] * (s.v[n] - held.of(n, s.v[n]));
  }
  if (m.body[0]) m.kicked += (0.5 * dt) * m.body[0]->acceleration_at(m.arm[0]);
  if (m.body[1]) m.kicked -= (0.5 * dt) * m.body[1]->acceleration_at(m.arm[1]);
  m.softness = dot(m.normal, m.response(s, held, m.normal));
  double trace = 0;
  for (int d = 0; d < 3; ++d) {
    Vec3 axis{};
    axis[d] = 1;
    trace += m.response(s, held, axis)[d];
  }
  m.side_softness = trace - m.softness;  // a bound of what it is in any direction along the face
  const double u = dot(m.before, m.normal), u1 = u - 2 * dot(m.kicked, m.normal), reach = -std::max(m.gap, 0.0) / dt;
  const bool bounces = m.body[0] && m.body[1] && restitution > 0 && u < reach;
  m.target = bounces ? -restitution * u : std::min(reach, -u1);
}

namespace {

/// One sweep; returns the largest change of a relative velocity.
double sweep(std::span<Meeting> meetings, State& s, const Supports& held, double friction) {
  double change = 0;
  for (Meeting& m : meetings) {
    if (!(m.softness > 0)) continue;
    const Vec3& n = m.normal;
    const double old = dot(m.impulse, n);
    const double now = std::max(0.0, old + (m.target - dot(m.velocity(s), n)) / m.softness);
    if (now != old) m.push(s, held, (now - old) * n);
    m.impulse += (now - old) * n;
    change = std::max(change, std::fabs(now - old) * m.softness);
    const Vec3 tangential = m.impulse - now * n;
    const double limit = m.body[0] || m.body[1] ? friction * now : 0;
    if ((limit == 0 && tangential == Vec3{}) || !(m.side_softness > 0)) continue;
    const Vec3 v = m.velocity(s);
    Vec3 wish = tangential - (1 / m.side_softness) * (v - dot(v, n) * n);
    if (const double length = norm(wish); length > limit) wish = (limit / length) * wish;
    m.push(s, held, wish - tangential);
    m.impulse += wish - tangential;
    change = std::max(change, norm(wish - tangential) * m.side_softness);
  }
  return change;
}

}  // namespace

double solve(std::span<Meeting> meetings, State& s, const Supports& held, double friction) {
  bool is_rigid = true;
  double fastest = 0;
  for (const Meeting& m : meetings) {
    is_rigid = is_rigid && m.body[0] && m.body[1];
    fastest = std::max(fastest, norm(m.before));
  }
  // what a large island lacks the next step sees
  const bool is_exact = is_rigid && meetings.size() <= 64, is_large = meetings.size() > 2000;
  const int most = is_exact ? 500 : is_large ? 20 : 200;
  const double enough = (is_exact ? 1e-14 : is_large ? 1e-4 : 1e-6) * fastest;
  for (int k = 0; k < most; ++k)
    if (sweep(meetings, s, held, friction) <= enough) break;
  // the work in the frame of supports is a quadratic of a common factor of all impulses
  double linear = 0, square = 0, support = 0;
  for (const Meeting& m : meetings) {
    linear += dot(m.impulse, m.before - m.kicked);
    square += 0.5 * dot(m.impulse, m.velocity(s) - m.before);
    support += dot(m.impulse, m.supported);
  }
  if (linear + square <= 0) return linear + square - support;
  const double part = square > 0 ? std::clamp(-linear / square, 0.0, 1.0) : 0;
  for (Meeting& m : meetings) {
    m.push(s, held, (part - 1) * m.impulse);
    m.impulse = part * m.impulse;
  }
  return part * linear + part * part * square - part * support;
}

}  // namespace bw::csd
