// SPDX-License-Identifier: Apache-2.0
#include "coupling/loads.h"

#include <algorithm>

#include "common/app/error.h"
#include "common/parallel/exact_sums.h"

namespace bw::coupling {

std::vector<Vec3> area_vectors(const WetSurface& surface) {
  std::vector<Vec3> area(surface.quads.size());
  const auto find_area = [&](int64_t f) { area[size_t(f)] = area_vector(surface.x, surface.quads[size_t(f)]); };
  parallel_for(int64_t(area.size()), find_area, worth_waking);
  return area;
}

std::vector<Vec3> face_forces(std::span<const Vec3> area, const Loads& loads, double p_ref) {
  const size_t n = area.size();
  BW_CHECK(loads.p.size() == n && (loads.traction.empty() || loads.traction.size() == n));
  std::vector<Vec3> force(n);
  const auto force_on = [&](int64_t i) {
    const size_t f = size_t(i);
    force[f] = -(loads.p[f] - p_ref) * area[f];
    if (!loads.traction.empty()) force[f] += norm(area[f]) * loads.traction[f];
  };
  parallel_for(int64_t(n), force_on, worth_waking);
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
  enum { impulse, moment = 3, work = 6, swept, sums };
  const auto add_face = [&](size_t f, std::array<double, sums>& s) {
    const auto& q = surface.quads[f];
    const Vec3 area = area_vector(surface.x, q), v = face_mean(v_wall, q);
    Vec3 force = -loads.p[f] * area;
    if (!loads.traction.empty()) force += norm(area) * loads.traction[f];
    add_at(s, impulse, force), add_at(s, moment, cross(face_mean(surface.x, q), force));
    s[work] += dot(force, v), s[swept] += dot(area, v);
  };
  const auto sum = exact_sums<sums>(loads.p.size(), add_face);
  FluidTotals totals;
  totals.impulse = dt * vector_at(sum, impulse);
  totals.moment = dt * vector_at(sum, moment);
  totals.work = sum[work] * dt;
  totals.swept = sum[swept] * dt;
  return totals;
}

}  // namespace bw::coupling
