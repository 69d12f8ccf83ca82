// SPDX-License-Identifier: Apache-2.0
#include "cfd/afterburn.h"

#include <fmt/format.h>

#include "common/app/error.h"
#include "common/parallel/loop.h"

namespace bw::cfd {

namespace {

struct Weighted {
  double mass = 0, pressure = 0;  ///< kg; kg Pa
};

/// Mass mean over the explosive [Pa], block by block over all ranks.
double mean_pressure(const Model& m) {
  std::vector<Weighted> part(size_t(m.forest.local_blocks()));
  parallel_for_dynamic(m.forest.local_blocks(), [&](int64_t b) {
    if (m.state.info[size_t(b)].material >= 2) return;
    const BlockShape& s = m.forest.shape(int(b));
    const std::vector<uint8_t> blocked = blocked_cells(m, int(b));
    const double lower = m.forest.lower(int(b)).x;
    Weighted sum;
    std::visit(
        [&](const auto& pair) {
          for (size_t cell = 0; cell < size_t(s.cells()); ++cell) {
            double U[Cons::most], W[Prim::most];
            for (int q = 0; q < m.state.rows(); ++q) U[q] = m.state.block(int(b), q)[cell];
            if (!(U[Cons::arho1] > 0) || (!blocked.empty() && blocked[cell])) continue;
            pair.to_primitive(U, W, m.setup.medium.floors);
            const double mass = U[Cons::arho1] * s.cell_volume(lower, int(cell % size_t(s.n[0])));
            sum.mass += mass, sum.pressure += mass * W[Prim::p];
          }
        },
        m.setup.medium.mixture);
    part[size_t(b)] = sum;
  });
  Weighted total;
  for (const Weighted& w : m.forest.comm().size() == 1 ? part : m.forest.comm().gather_all(part))
    total.mass += w.mass, total.pressure += w.pressure;
  return total.mass > 0 ? total.pressure / total.mass : 0;
}

}  // namespace

void begin_afterburn(Model& m) {
  if (!m.setup.afterburn) return;
  Afterburn& after = *m.setup.afterburn;
  const double burnt = m.setup.burn ? m.setup.burn->t_all : 0;
  if (m.afterburn_follows) after.begin = burnt;
  if (after.begin < burnt)  // explosive that has not detonated would burn on
    throw InputError(fmt::format("{}: expected begin not before the end of the programmed burn, {:.4g} s",
                                 m.afterburn_place, burnt));
  if (after.kind == Afterburn::Kind::constant && !(after.end > after.begin))
    throw InputError(
        fmt::format("{}: expected end after the end of the programmed burn, {:.4g} s", m.afterburn_place, after.begin));
}

double share_after(const Model& m, double dt) {
  if (!m.setup.afterburn) return 0;
  const Afterburn& after = *m.setup.afterburn;
  const double t = m.state.t;
  return after.share_at(t, t + dt, after.needs_pressure(t + dt) ? mean_pressure(m) : 0);
}

double afterburn_energy(const Model& m, double share) {
  return m.setup.afterburn->energy * (share - m.setup.afterburn->share);
}

}  // namespace bw::cfd
