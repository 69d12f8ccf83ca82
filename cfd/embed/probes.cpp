// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/probes.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/loop.h"
#include "coupling/loads.h"

namespace bw::cfd {
namespace {

bool nearest_cell(const Lattice& g, const Vec3& x, Index3& c) {
  for (int d = 0; d < 3; ++d) {
    const double i = std::floor((x[d] - g.lower[d]) / g.h[d]);
    if (!(i >= 0 && i < g.n[size_t(d)])) return false;
    c[size_t(d)] = int(i);
  }
  return true;
}

/// Going from cell c to the cell of the face axis by axis, is the first wall one that faces c as this face does? (If
/// not, c lies behind another body.)
bool sees(const CutMap& map, Index3 c, const Index3& face_cell, const Vec3& n) {
  for (size_t d = 0; d < 3; ++d)
    while (c[d] != face_cell[d]) {
      const bool up = face_cell[d] > c[d];
      Index3 low = c;
      if (!up) --low[d];
      if (const CutLink* l = map.link(low, int(d))) return dot((up ? l->below : l->above).n, n) > 0;
      c[d] += up ? 1 : -1;
    }
  return true;
}

bool find_cell(const CutMap& map, const Vec3& x, const Vec3& n, Index3& found) {
  const Lattice& g = map.lattice();
  // length of a cell along the normal
  double h = 0;
  for (int d = 0; d < 3; ++d)
    if (g.active(d)) h += std::abs(n[d]) * g.h[d];
  if (h == 0) return false;
  Index3 home;
  const bool inside = nearest_cell(g, x, home);
  for (const double reach : {0.5, 1.0, 1.5, 2.0}) {
    Index3 c;
    if (!nearest_cell(g, x + reach * h * n, c) || map.blocked(c)) continue;
    const Vec3 away = g.centre(c) - x;
    double ahead = 0;
    for (int d = 0; d < 3; ++d)
      if (g.active(d)) ahead += n[d] * away[d];
    if (ahead <= 1e-6 * h || (inside && !sees(map, c, home, n))) continue;
    found = c;
    return true;
  }
  return false;
}

}  // namespace

std::vector<Probe> find_probes(const coupling::WetSurface& surface, const CutMap& map) {
  const size_t faces = surface.quads.size();
  std::vector<Probe> front(faces), back(faces);
  parallel_for(int64_t(faces), [&](int64_t i) {
    const size_t f = size_t(i);
    const auto& q = surface.quads[f];
    const Vec3 area = coupling::area_vector(surface.x, q);
    const double size = norm(area);
    if (size == 0) return;
    const Vec3 x = coupling::face_mean(surface.x, q), v = coupling::face_mean(surface.v, q), n = area / size;
    if (Index3 c; find_cell(map, x, n, c)) front[f] = {int32_t(f), 1, c, x, n, v};
    if (!surface.flags.empty() && surface.flags[f] & coupling::face_thin)
      if (Index3 c; find_cell(map, x, -n, c)) back[f] = {int32_t(f), -1, c, x, -n, v};
  });
  std::vector<Probe> probes;
  for (size_t f = 0; f < faces; ++f)
    for (const Probe* p : {&front[f], &back[f]})
      if (p->face >= 0) probes.push_back(*p);
  return probes;
}

}  // namespace bw::cfd
