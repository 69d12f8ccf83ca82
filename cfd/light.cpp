// SPDX-License-Identifier: Apache-2.0
#include "cfd/light.h"

#include <fmt/format.h>

#include <cmath>

#include "cfd/source/paths.h"
#include "common/app/error.h"
#include "common/app/log.h"

namespace bw::cfd {
namespace {

/// visit(block, cell, k, j, i, centre) of this rank's cells with a share of explosive above `least`.
template <class Visit>
void each_explosive_cell(const Model& m, double least, const Visit& visit) {
  for (int b = 0; b < m.forest.local_blocks(); ++b) {
    const BlockShape& s = m.forest.shape(b);
    const Vec3 lower = m.forest.lower(b);
    const std::vector<uint8_t> blocked = blocked_cells(m, b);
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          const size_t cell = s.at(k, j, i);
          if (!(m.state.block(b, Cons::alpha1)[cell] > least) || (!blocked.empty() && blocked[cell])) continue;
          visit(b, Index3{i, j, k}, lower + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z});
        }
  }
}

void check_points(const Model& m, const Burn& burn, const std::string& place) {
  for (const Vec3& p : burn.points) {
    const Forest::Cell c = m.forest.find(p);
    bool inside = false;
    if (c.block >= 0) {
      const std::vector<uint8_t> blocked = blocked_cells(m, c.block);
      const size_t cell = m.forest.shape().at(c.k, c.j, c.i);
      inside = (blocked.empty() || !blocked[cell]) && m.state.block(c.block, Cons::alpha1)[cell] > 0.5;
    }
    if (m.forest.comm().max(int64_t(inside)) == 0)
      throw InputError(fmt::format("{}: expected detonation points inside the explosive", place));
  }
}

/// The finest level's cells around the explosive, the same on all ranks.
ExplosiveCells explosive_cells(const Model& m) {
  const Forest& forest = m.forest;
  const BlockShape& s = forest.finest_shape();
  const auto visit_finest = [&](const auto& visit) {
    each_explosive_cell(m, 0.5, [&](int b, const Index3& cell, const Vec3&) {
      if (forest.level(b) != forest.levels()) return;  // explosive that is not burnt is of the finest level
      Index3 at = forest.first_cell(b);
      for (size_t d = 0; d < 3; ++d) at[d] += cell[d];
      visit(at);
    });
  };
  int64_t low[3], high[3];
  for (int d = 0; d < 3; ++d) low[d] = -(int64_t(1) << 40), high[d] = -(int64_t(1) << 40);
  visit_finest([&](const Index3& at) {
    for (size_t d = 0; d < 3; ++d)
      low[d] = std::max(low[d], -int64_t(at[d])), high[d] = std::max(high[d], int64_t(at[d]));
  });
  ExplosiveCells cells;
  cells.h = s.h;
  Index3 first;
  for (size_t d = 0; d < 3; ++d) {
    first[d] = int(-forest.comm().max(low[d]));
    cells.n[d] = int(forest.comm().max(high[d])) - first[d] + 1;
    if (cells.n[d] <= 0) return {};
    if (s.used[d]) first[d] -= 2, cells.n[d] += 4;  // cells beside it take part in the burn as well
    cells.lower[int(d)] = forest.size().lower[int(d)] + (first[d] + 0.5) * s.h[int(d)];
  }
  std::vector<double> inside(size_t(cells.n[0]) * size_t(cells.n[1]) * size_t(cells.n[2]), 0.0);
  visit_finest([&](const Index3& at) {
    inside[(size_t(at[2] - first[2]) * size_t(cells.n[1]) + size_t(at[1] - first[1])) * size_t(cells.n[0]) +
           size_t(at[0] - first[0])] = 1;
  });
  if (forest.comm().size() > 1) forest.comm().sum(inside);
  cells.inside.assign(inside.begin(), inside.end());
  return cells;
}

}  // namespace

void light(Model& m, const Case& cs) {
  Burn& burn = *m.setup.burn;
  const BurnCase& given = cs.fluid.burn[0];
  check_points(m, burn, given.place);
  double nearest = 1e300;
  each_explosive_cell(m, 0.5,
                      [&](int, const Index3&, const Vec3& x) { nearest = std::min(nearest, burn.straight(x)); });
  nearest = -m.forest.comm().max(-nearest);
  if (nearest > 2 * burn.margin)
    throw InputError(
        fmt::format("{}: expected lines or planes that touch the explosive; it is {:g} m away", given.place, nearest));
  burn.ways = {};
  if (given.path == "auto" && !m.forest.shape().radial()) {
    int64_t unreached = 0;
    const ExplosiveCells cells = explosive_cells(m);
    if (!cells.inside.empty()) burn.ways = find_ways(burn, cells, unreached);
    if (!burn.ways.empty())
      say("the burn goes around corners, up to {:.4g} m further than straight lines", burn.ways.most);
    if (unreached > 0)
      warn("{} cells of explosive are not joined to what is lit: they burn as if the front went there straight",
           unreached);
  }
  double far = 0;
  each_explosive_cell(m, 0, [&](int, const Index3&, const Vec3& x) { far = std::max(far, burn.distance(x)); });
  far = m.forest.comm().max(far);
  burn.t_all = burn.start + (2 * far + (burn.width + 2) * burn.h) / burn.D;  // the explosive may have moved meanwhile
}

}  // namespace bw::cfd
