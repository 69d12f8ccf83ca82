// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/cavity.h"

#include <cmath>
#include <numeric>

#include "cfd/embed/predicates.h"
#include "cfd/embed/scan.h"

namespace bw::cfd {

std::vector<double> component_volumes(const coupling::WetSurface& s, std::vector<int32_t>& component) {
  std::vector<int32_t> root(s.x.size());
  std::iota(root.begin(), root.end(), 0);
  auto find = [&](int32_t a) {
    while (root[size_t(a)] != a) a = root[size_t(a)] = root[size_t(root[size_t(a)])];
    return a;
  };
  for (const auto& q : s.quads)
    for (size_t i = 1; i < 4; ++i) {
      const int32_t a = find(q[0]), b = find(q[i]);
      root[size_t(std::max(a, b))] = std::min(a, b);
    }
  std::vector<int32_t> number(s.x.size(), -1);
  std::vector<double> volume;
  component.resize(s.quads.size());
  for (size_t f = 0; f < s.quads.size(); ++f) {
    int32_t& c = number[size_t(find(s.quads[f][0]))];
    if (c < 0) {
      c = int32_t(volume.size());
      volume.push_back(0);
    }
    component[f] = c;
    const Vec3 origin = s.x[size_t(find(s.quads[f][0]))];  // near: less cancellation
    for_each_triangle(s.x, s.quads[f], [&](const Vec3& a, const Vec3& b, const Vec3& d, int, int) {
      volume[size_t(c)] += triple(a - origin, b - origin, d - origin) / 6;
    });
  }
  return volume;
}

namespace {

/// Winding number of each component around x, by a ray along +x.
std::vector<int> windings(const coupling::WetSurface& s, const std::vector<int32_t>& component, size_t components,
                          const Vec3& x) {
  std::vector<int> w(components, 0);
  for (size_t f = 0; f < s.quads.size(); ++f)
    for_each_triangle(s.x, s.quads[f], [&](const Vec3& a, const Vec3& b, const Vec3& c, int, int) {
      const int side = side_of_line(a.y, a.z, b.y, b.z, x.y, x.z);
      if (side == 0 || side_of_line(b.y, b.z, c.y, c.z, x.y, x.z) != side ||
          side_of_line(c.y, c.z, a.y, a.z, x.y, x.z) != side)
        return;
      if (side_of_triangle(a, b, c, x) != side) w[size_t(component[f])] += side;  // the ray meets it ahead
    });
  return w;
}

}  // namespace

Cavity find_cavity(const coupling::WetSurface& surface, const CutMap& map, const Vec3& seed) {
  Cavity r;
  const Lattice& g = map.lattice();
  Index3 start;
  for (size_t d = 0; d < 3; ++d) {
    const double i = std::floor((seed[int(d)] - g.lower[int(d)]) / g.h[int(d)]);
    if (!(i >= 0 && i < g.n[d])) return r;
    start[d] = int(i);
  }
  if (map.blocked(start)) return r;
  std::vector<bool> seen(size_t(g.n[0]) * size_t(g.n[1]) * size_t(g.n[2]));
  auto number = [&](const Index3& c) {
    return (size_t(c[2]) * size_t(g.n[1]) + size_t(c[1])) * size_t(g.n[0]) + size_t(c[0]);
  };
  r.cells.push_back(start);
  seen[number(start)] = true;
  for (size_t next = 0; next < r.cells.size(); ++next) {
    const Index3 c = r.cells[next];
    for (int d = 0; d < 3; ++d) {
      if (!g.active(d)) continue;
      for (int up = 0; up < 2; ++up) {
        Index3 to = c;
        to[size_t(d)] += up ? 1 : -1;
        if (map.is_cut(up ? c : to, d)) continue;
        if (!map.inside(to)) {
          r.reaches_boundary = true;
          continue;
        }
        if (map.blocked(to) || seen[number(to)]) continue;
        seen[number(to)] = true;
        r.cells.push_back(to);
      }
    }
  }
  r.cell_volume = double(r.cells.size()) * g.h.x * g.h.y * g.h.z;
  std::vector<int32_t> component;
  const std::vector<double> volume = component_volumes(surface, component);
  const std::vector<int> w = windings(surface, component, volume.size(), seed);
  // normals point into the fluid: the wall of the cavity winds around the seed the other way; bodies in it take their
  // volume away
  double outer = 0;
  for (size_t c = 0; c < volume.size(); ++c)
    if (w[c] != 0 && volume[c] < 0 && (outer == 0 || -volume[c] < outer)) outer = -volume[c];
  r.exact_volume = outer;
  return r;
}

}  // namespace bw::cfd
