// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/motion.h"

#include <algorithm>
#include <cmath>

#include "cfd/embed/predicates.h"
#include "cfd/embed/scan.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

struct Triangle {
  Vec3 a, b, c;
};

/// Does the plane of the moving triangle go over q, with q within the triangle (a hair more) then?
bool passes(const Triangle& old, const Triangle& now, const Vec3& q) {
  if (side_of_triangle(old.a, old.b, old.c, q) == side_of_triangle(now.a, now.b, now.c, q)) return false;
  const double v0 = triple(old.b - old.a, old.c - old.a, q - old.a),
               v1 = triple(now.b - now.a, now.c - now.a, q - now.a);
  const double t = v0 == v1 ? 0.5 : std::clamp(v0 / (v0 - v1), 0.0, 1.0);
  const Vec3 a = old.a + t * (now.a - old.a), b = old.b + t * (now.b - old.b), c = old.c + t * (now.c - old.c);
  const Vec3 n = cross(b - a, c - a);
  const double hair = -1e-6 * dot(n, n);
  return dot(cross(b - q, c - q), n) >= hair && dot(cross(c - q, a - q), n) >= hair &&
         dot(cross(a - q, b - q), n) >= hair;
}

/// Is a centre in the box of all that face q sweeps? Most faces are smaller than a cell.
bool may_pass_centre(const coupling::WetSurface& surface, const std::vector<Vec3>& x_before,
                     const std::array<int32_t, 4>& q, const Centres& centres) {
  for (int d = 0; d < 3; ++d) {
    double lower = surface.x[size_t(q[0])][d], upper = lower;
    for (const int32_t node : q)
      for (const double x : {surface.x[size_t(node)][d], x_before[size_t(node)][d]})
        lower = std::min(lower, x), upper = std::max(upper, x);
    if (centres.between(d, lower, upper).empty()) return false;
  }
  return true;
}

void add_swept(const Triangle& old, const Triangle& now, const Lattice& g, const Centres& centres,
               std::vector<Index3>& out) {
  int first[3], last[3];
  for (int d = 0; d < 3; ++d) {
    const auto [lo, hi] = std::minmax({old.a[d], old.b[d], old.c[d], now.a[d], now.b[d], now.c[d]});
    const Centres::Range r = centres.between(d, lo, hi);
    if (r.empty()) return;
    first[d] = r.first, last[d] = r.last;
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        if (passes(old, now, g.centre({i, j, k}))) out.push_back({i, j, k});
}

}  // namespace

std::vector<Index3> swept_cells(const coupling::WetSurface& surface, const std::vector<Vec3>& x_before,
                                const Lattice& lattice) {
  constexpr int64_t chunk = 4096;
  const int64_t faces = int64_t(surface.quads.size()), chunks = (faces + chunk - 1) / chunk;
  const Centres centres(lattice);
  std::vector<std::vector<Index3>> part(static_cast<size_t>(chunks));
  parallel_for_dynamic(chunks, [&](int64_t p) {
    for (int64_t f = p * chunk; f < std::min(faces, (p + 1) * chunk); ++f) {
      const auto& q = surface.quads[size_t(f)];
      if (!may_pass_centre(surface, x_before, q, centres)) continue;
      Triangle old[4], now[4];
      int n = 0, m = 0;
      for_each_triangle(x_before, q, [&](const Vec3& a, const Vec3& b, const Vec3& c, int, int) {
        old[n++] = {a, b, c};
      });
      for_each_triangle(surface.x, q, [&](const Vec3& a, const Vec3& b, const Vec3& c, int, int) {
        now[m++] = {a, b, c};
      });
      for (int i = 0; i < n; ++i) add_swept(old[i], now[i], lattice, centres, part[size_t(p)]);
    }
  });
  std::vector<Index3> cells;
  for (const auto& p : part) cells.insert(cells.end(), p.begin(), p.end());
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

Changes compare(const CutMap& before, CutMap& now, const std::vector<Index3>& swept) {
  Changes r;
  std::vector<Index3> waiting;
  CutMap::for_each_difference(before, now, [&](const Index3& c) {
    const bool was = before.blocked(c), is = now.blocked(c);
    if (was && !is) waiting.push_back(c);
    if (!was && is) r.covered.push_back(c);
  });
  for (const Index3& c : swept)
    if (!before.blocked(c) && !now.blocked(c)) waiting.push_back(c);
  for (const Index3& c : waiting) now.set_flag(c, cell_fresh);

  // layer by layer from the fluid: a cell is ready when a neighbour over an uncut link has valid fluid
  const Lattice& g = now.lattice();
  auto reached = [&](const Index3& c) {
    for (int d = 0; d < 3; ++d) {
      if (!g.active(d)) continue;
      for (int side = 0; side < 2; ++side) {
        Index3 other = c;
        other[d] += side ? 1 : -1;
        if (!now.inside(other) || now.is_cut(side ? c : other, d)) continue;
        if (!(now.flags(other) & (cell_blocked | cell_fresh))) return true;
      }
    }
    return false;
  };
  for (int layer = 1; !waiting.empty(); ++layer) {
    std::vector<Index3> ready, rest;
    for (const Index3& c : waiting) (reached(c) ? ready : rest).push_back(c);
    if (ready.empty()) break;
    for (const Index3& c : ready) {
      now.drop_flag(c, cell_fresh);
      r.fresh.push_back({c, layer, !before.blocked(c)});
    }
    r.layers = layer;
    waiting.swap(rest);
  }
  for (const FreshCell& f : r.fresh) now.set_flag(f.cell, cell_fresh);
  for (const Index3& c : waiting) {
    now.drop_flag(c, cell_fresh);
    now.set_flag(c, cell_sealed);
    if (!before.blocked(c)) r.covered.push_back(c);
  }
  r.sealed = int64_t(waiting.size());
  if (r.sealed > 0) now.note_orphans();
  return r;
}

}  // namespace bw::cfd
