// SPDX-License-Identifier: Apache-2.0
// The part of Bodies that belongs to bodies which the flow moves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cfd/embed/body.h"
#include "cfd/embed/scan.h"
#include "cfd/embed/walls.h"
#include "common/app/error.h"

namespace bw::cfd {
namespace {

/// The gas that a body moves resists like rho c A; a step longer than this part of m/(rho c A) could swing.
constexpr double lag_share = 0.3;

MassProperties mass_of(const BodyCase& body, const FreeMotion& motion, const std::vector<Vec3>& X,
                       const std::vector<std::array<int32_t, 4>>& quads, bool thin) {
  MassProperties m = thin ? MassProperties{} : solid_of(X, quads);
  const bool closed = m.mass > 0, given = motion.mass > 0 && !motion.inertia.empty() && motion.centre;
  if (!closed && !given)
    throw InputError(fmt::format("{}: expected mass, inertia and centre of body \"{}\", whose surface encloses nothing",
                                 motion.place, body.name));
  const double density = motion.density > 0 ? motion.density : closed ? motion.mass / m.mass : 0;
  m.mass = motion.density > 0 ? density * m.mass : motion.mass;
  m.inertia = density * m.inertia;
  if (motion.centre) m.centre = *motion.centre;
  if (!motion.inertia.empty())
    for (int d = 0; d < 3; ++d) m.inertia.row[d] = {}, m.inertia(d, d) = motion.inertia[size_t(d)];
  return m;
}

}  // namespace

void Bodies::add_free(const BodyCase& body, const FreeMotion& motion, int32_t first_face) {
  const std::vector<std::array<int32_t, 4>> quads(surface_.quads.begin() + first_face, surface_.quads.end());
  const bool thin = (surface_.flags.back() & coupling::face_thin) != 0;
  const MassProperties mass = mass_of(body, motion, X_, quads, thin);
  FreeBody f{body.name,  RigidBody(mass, motion.free, motion.velocity, motion.spin),
             first_face, int32_t(surface_.quads.size()),
             {},         {}};
  beside_.resize(size_t(first_face), {-1, -1, -1, -1});
  std::map<std::pair<int32_t, int32_t>, std::pair<int32_t, size_t>> open;  // edge -> its first face
  for (size_t n = 0; n < quads.size(); ++n) {
    const auto& q = quads[n];
    f.area.push_back(coupling::area_vector(X_, q));
    Vec3 lever;
    for_each_triangle(X_, q, [&](const Vec3& a, const Vec3& b, const Vec3& c, int, int) {
      lever += cross((a + b + c) / 3.0 - mass.centre, 0.5 * cross(b - a, c - a));
    });
    f.lever.push_back(lever);
    beside_.push_back({-1, -1, -1, -1});
    for (size_t e = 0; e < 4; ++e) {
      const auto edge = std::minmax(q[e], q[(e + 1) % 4]);
      if (edge.first == edge.second) continue;
      const int32_t here = first_face + int32_t(n);
      const auto [at, is_new] = open.try_emplace(edge, here, e);
      if (is_new) continue;
      beside_[size_t(here)][e] = at->second.first;
      beside_[size_t(at->second.first)][at->second.second] = here;
    }
  }
  free_of_.back() = int32_t(free_.size());
  free_.push_back(std::move(f));
}

void Bodies::limit_step(const std::function<double(size_t)>& rho_c_area) {
  largest_step_ = 1e300;
  for (const FreeBody& f : free_) {
    const Mat3 R = f.rigid.place().turn.matrix(), inv = f.rigid.inverse_inertia(f.rigid.place().turn);
    Mat3 lag{};  // of translation; of the turns its trace
    double turn_lag = 0;
    for (size_t n = 0; n < f.area.size(); ++n) {
      const double square = dot(f.area[n], f.area[n]),
                   z = square > 0 ? rho_c_area(size_t(f.first_face) + n) / square : 0;
      if (z == 0) continue;
      const Vec3 A = R * f.area[n], b = R * f.lever[n];
      for (int d = 0; d < 3; ++d)
        for (int e = 0; e < 3; ++e)
          if (f.rigid.free(d) && f.rigid.free(e)) lag(d, e) += z * A[d] * A[e];
      turn_lag += z * dot(b, inv * b);
    }
    double most = 0;
    for (const Vec3& row : lag.row) most = std::max(most, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
    const double rate = most / f.rigid.mass().mass + turn_lag;
    if (rate > 0) largest_step_ = std::min(largest_step_, lag_share / rate);
  }
}

void Bodies::begin(double rho_c) {
  limit_step([&](size_t face) { return rho_c * norm(coupling::area_vector(X_, surface_.quads[face])); });
}

void Bodies::advance(double dt, const coupling::Loads& loads, double p_ref, const FaceForces* links) {
  for (FreeBody& f : free_) {
    const RigidBody::Place half = f.rigid.halfway(dt), end = f.rigid.after(dt);
    const Mat3 R = half.turn.matrix();
    const std::vector<double> p = pressures_of(f, half, loads, p_ref);
    Vec3 force, moment;    // of pressures, in the body's axes
    Vec3 met, met_moment;  // of links, in the case's, about the origin
    for (size_t n = 0; n < f.area.size(); ++n) {
      const size_t face = size_t(f.first_face) + n;
      if (links && (loads.impedance[face] > 0 || links->met[face])) {
        met += links->force[face], met_moment += links->moment[face];
      } else {
        force += -p[n] * f.area[n];
        moment += -p[n] * f.lever[n];
      }
    }
    // the walls' own way: straight, and turning evenly
    const Vec3 way = end.shift - f.rigid.place().shift, turned = f.rigid.turn_angle(dt);
    force = met + R * force;
    moment = met_moment - cross(f.rigid.mass().centre + half.shift, met) + R * moment;
    f.rigid.advance(dt, force, moment, dot(force, way) + dot(moment, turned));
  }
  limit_step([&](size_t face) {
    const double of_links = links ? links->rho_c_area[face] : 0;
    return of_links > 0 ? of_links : loads.impedance[face] * norm(coupling::area_vector(X_, surface_.quads[face]));
  });
}

std::vector<double> Bodies::pressures_of(const FreeBody& f, const RigidBody::Place& at, const coupling::Loads& loads,
                                         double p_ref) const {
  const size_t first = size_t(f.first_face), n = f.area.size();
  const Mat3 R = at.turn.matrix();
  std::vector<double> p(n);
  constexpr int to_find = -1, outside = -2;  // those keep the reference pressure
  std::vector<int> layer(n, 0);
  std::vector<size_t> waiting;
  for (size_t i = 0; i < n; ++i) {
    p[i] = loads.p[first + i] - p_ref;
    if (loads.impedance[first + i] > 0) continue;
    const Vec3 x = f.rigid.position(coupling::face_mean(X_, surface_.quads[first + i]), at), A = R * f.area[i];
    bool inside = true, faces_flow = false;
    for (int d = 0; d < 3; ++d) {
      inside = inside && x[d] >= setting_.lower[d] && x[d] <= setting_.upper[d];
      faces_flow = faces_flow || (setting_.active[size_t(d)] && std::abs(A[d]) > 1e-6 * norm(A));
    }
    layer[i] = inside && faces_flow ? to_find : outside;
    if (layer[i] == to_find) waiting.push_back(i);
  }
  for (int now = 1; !waiting.empty(); ++now) {
    std::vector<size_t> rest;
    for (const size_t i : waiting) {
      double sum = 0;
      int count = 0;
      for (const int32_t other : beside_[first + i])
        if (other >= 0 && layer[size_t(other) - first] >= 0 && layer[size_t(other) - first] < now)
          sum += p[size_t(other) - first], ++count;
      if (count > 0)
        p[i] = sum / count, layer[i] = now;
      else
        rest.push_back(i);
    }
    if (rest.size() == waiting.size()) break;  // no fluid anywhere around it
    waiting.swap(rest);
  }
  return p;
}

void Bodies::save(const Saved& to) const {
  std::vector<RigidBody::State> states;
  for (const FreeBody& f : free_) states.push_back(f.rigid.state());
  to.same("states", states);
  to.number("largest_step", largest_step_);
}

void Bodies::restore(const Restored& from) {
  const std::vector<RigidBody::State> states = from.same<RigidBody::State>("states");
  for (size_t i = 0; i < free_.size(); ++i) free_[i].rigid.restore(states.at(i));
  largest_step_ = from.number<double>("largest_step");
}

}  // namespace bw::cfd
