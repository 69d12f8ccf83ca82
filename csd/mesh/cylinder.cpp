// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/cylinder.h"

#include <algorithm>
#include <cmath>

#include "csd/mesh/box.h"
#include "csd/mesh/quads.h"

namespace bw::csd {

Mesh Box::make() const {
  const Quads q = quad_grid(cells[0], cells[1]);
  const auto gx = graded(cells[0], grading.x), gy = graded(cells[1], grading.y), gz = graded(cells[2], grading.z);
  const int row = cells[0] + 1;
  const auto between = [](double a, double b, double s) { return s == 1 ? b : a + s * (b - a); };
  Swept s = sweep(
      q, cells[2],
      [&](int i, int l) {
        return Vec3{between(lower.x, upper.x, gx[size_t(i % row)]), between(lower.y, upper.y, gy[size_t(i / row)]),
                    between(lower.z, upper.z, gz[size_t(l)])};
      },
      is_split);
  s.add_set("x_lower", [&](int i, int) { return i % row == 0; });
  s.add_set("x_upper", [&](int i, int) { return i % row == cells[0]; });
  s.add_set("y_lower", [&](int i, int) { return i / row == 0; });
  s.add_set("y_upper", [&](int i, int) { return i / row == cells[1]; });
  s.add_set("z_lower", [&](int, int l) { return l == 0; });
  s.add_set("z_upper", [&](int, int l) { return l == cells[2]; });
  return std::move(s.mesh);
}

namespace {
void add_cuts(Swept& s, const Quads& q, const std::string& axis, const std::string& sector) {
  const auto names = cross_axes(axis);
  if (sector == "quarter") s.add_set("cut_" + names[0], [&](int i, int) { return std::abs(q.p[size_t(i)].x) < 1e-12; });
  if (sector != "full") s.add_set("cut_" + names[1], [&](int i, int) { return std::abs(q.p[size_t(i)].y) < 1e-12; });
}
}  // namespace

Mesh Cylinder::make() const {
  const int core = std::max(1, across / 2);
  const Quads q = cut_sector(quad_disc(core, across - core, double(core) / across), sector);
  const auto g = graded(along, grading);
  Swept s = sweep(
      q, along,
      [&](int i, int l) {
        const double t = g[size_t(l)], r = radius + t * (upper_radius - radius);
        return along_axis(axis, base, {r * q.p[size_t(i)].x, r * q.p[size_t(i)].y, t * length});
      },
      is_split);
  s.add_set("lower", [&](int, int l) { return l == 0; });
  s.add_set("upper", [&](int, int l) { return l == along; });
  s.add_set("side", [&](int i, int) { return std::hypot(q.p[size_t(i)].x, q.p[size_t(i)].y) > 1 - 1e-9; });
  add_cuts(s, q, axis, sector);
  return std::move(s.mesh);
}

Mesh Tube::make() const {
  const Quads q = cut_sector(quad_annulus(around, through), sector);
  const auto g = graded(along, grading);
  Swept s = sweep(
      q, along,
      [&](int i, int l) {
        const auto& p = q.p[size_t(i)];
        const double unit = std::hypot(p.x, p.y), r = inner_radius + (unit - 1) * (outer_radius - inner_radius);
        return along_axis(axis, base, {r * (p.x / unit), r * (p.y / unit), g[size_t(l)] * length});
      },
      is_split);
  s.add_set("inner", [&](int i, int) { return std::hypot(q.p[size_t(i)].x, q.p[size_t(i)].y) < 1 + 1e-9; });
  s.add_set("outer", [&](int i, int) { return std::hypot(q.p[size_t(i)].x, q.p[size_t(i)].y) > 2 - 1e-9; });
  s.add_set("lower", [&](int, int l) { return l == 0; });
  s.add_set("upper", [&](int, int l) { return l == along; });
  add_cuts(s, q, axis, sector);
  return std::move(s.mesh);
}

}  // namespace bw::csd
