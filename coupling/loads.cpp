// SPDX-License-Identifier: Apache-2.0
#include "coupling/loads.h"

#include <algorithm>

#include "common/app/error.h"
#include "common/math/sum.h"

namespace bw::coupling {

std::vector<Vec3> face_forces(const WetSurface& surface, const Loads& loads, double p_ref) {
  const size_t n = surface.quads.size();
  BW_CHECK(loads.p.size() == n && (loads.traction.empty() || loads.traction.size() == n));
  std::vector<Vec3> force(n);
  for (size_t f = 0; f < n; ++f) {
    const Vec3 area = area_vector(surface.x, surface.quads[f]);
    force[f] = -(loads.p[f] - p_ref) * area;
    if (!loads.traction.empty()) force[f] += norm(area) * loads.traction[f];
  }
  return force;
}

std::vector<Vec3> nodal_loads(const WetSurface& surface, std::span<const Vec3> face_force) {
  BW_CHECK(face_force.size() == surface.quads.size());
  std::vector<Vec3> nodal(surface.x.size());
  for (size_t f = 0; f < face_force.size(); ++f) {
    const auto& q = surface.quads[f];
    const int corners = is_triangle(q) ? 3 : 4;
    const Vec3 part = face_force[f] / double(corners);
    for (int c = 0; c < corners; ++c) nodal[size_t(q[size_t(c)])] += part;
  }
  return nodal;
}

FluidTotals wall_totals(const WetSurface& surface, const Loads& loads, std::span<const Vec3> v_wall,
                        const Window& window) {
  BW_CHECK(loads.p.size() == surface.quads.size() && v_wall.size() == surface.x.size());
  const double dt =
      loads.t1 - window.t0;  // not the fluid's own step: t1 is rounded, and both sides must count the same time
  ExactSum3 impulses, moments;
  ExactSum work, swept;
  for (size_t begin = 0; begin < loads.p.size(); begin += terms_at_once) {
    Vec3 force, moment;
    double power = 0, rate = 0;
    for (size_t f = begin; f < std::min(begin + terms_at_once, loads.p.size()); ++f) {
      const auto& q = surface.quads[f];
      const Vec3 area = area_vector(surface.x, q), v = face_mean(v_wall, q);
      Vec3 one = -loads.p[f] * area;
      if (!loads.traction.empty()) one += norm(area) * loads.traction[f];
      force += one, moment += cross(face_mean(surface.x, q), one);
      power += dot(one, v), rate += dot(area, v);
    }
    impulses += dt * force, moments += dt * moment;
    work += power * dt, swept += rate * dt;
  }
  FluidTotals totals;
  totals.impulse = impulses.value();
  totals.moment = moments.value();
  totals.work = work.value();
  totals.swept = swept.value();
  return totals;
}

}  // namespace bw::coupling
