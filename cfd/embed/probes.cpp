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

void find_probes(const coupling::WetSurface& surface, const CutMap& map, size_t groups,
                 const std::function<size_t(const Index3&)>& group_of, std::vector<Probe>& probes,
                 std::vector<size_t>& first) {
  const size_t faces = surface.quads.size();
  const bool thin = std::any_of(surface.flags.begin(), surface.flags.end(), [](int32_t f) { return f & coupling::face_thin; });
  const size_t sides = thin ? 2 : 1;
  struct Seen {
    Index3 cell;
    int32_t group = -1;
  };
  std::vector<Seen> seen(sides * faces);
  parallel_for(int64_t(faces), [&](int64_t i) {
    const size_t f = size_t(i);
    const auto& q = surface.quads[f];
    const Vec3 area = coupling::area_vector(surface.x, q);
    const double size = norm(area);
    if (size == 0) return;
    const Vec3 x = coupling::face_mean(surface.x, q), n = area / size;
    for (size_t side = 0; side < sides; ++side) {
      if (side == 1 && !(surface.flags[f] & coupling::face_thin)) continue;
      Seen& s = seen[sides * f + side];
      if (find_cell(map, x, side ? -n : n, s.cell)) s.group = int32_t(group_of(s.cell));
    }
  });
  first.assign(groups + 1, 0);
  for (const Seen& s : seen)
    if (s.group >= 0) ++first[size_t(s.group) + 1];
  for (size_t g = 0; g < groups; ++g) first[g + 1] += first[g];
  std::vector<size_t> next(first.begin(), first.end() - 1);
  std::vector<size_t> place(seen.size());
  for (size_t i = 0; i < seen.size(); ++i)
    if (seen[i].group >= 0) place[i] = next[size_t(seen[i].group)]++;
  probes.resize(first.back());
  parallel_for(int64_t(seen.size()), [&](int64_t i) {
    const Seen& s = seen[size_t(i)];
    if (s.group < 0) return;
    const size_t f = size_t(i) / sides;
    const auto& q = surface.quads[f];
    const int32_t side = size_t(i) % sides ? -1 : 1;
    const Vec3 area = coupling::area_vector(surface.x, q);
    probes[place[size_t(i)]] = {int32_t(f), side, s.cell, coupling::face_mean(surface.x, q), double(side) * (area / norm(area)),
                                coupling::face_mean(surface.v, q)};
  });
}

std::vector<Probe> find_probes(const coupling::WetSurface& surface, const CutMap& map) {
  std::vector<Probe> probes;
  std::vector<size_t> first;
  find_probes(surface, map, 1, [](const Index3&) { return 0; }, probes, first);
  return probes;
}

}  // namespace bw::cfd
