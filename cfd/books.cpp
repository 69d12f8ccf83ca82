// SPDX-License-Identifier: Apache-2.0
#include "cfd/books.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "common/parallel/loop.h"

namespace bw::cfd {

namespace {

FluidSums shells(const Model& m, int b) {
  FluidSums sum;
  const BlockShape& s = m.forest.shape(b);
  for (int i = 0; i < s.n[0]; ++i) {
    const double volume = s.cell_volume(m.forest.lower(b).x, i);
    for (int q = 0; q < m.state.rows(); ++q) sum.U[q] += m.state.block(b, q)[i] * volume;
    sum.volume += volume;
  }
  return sum;
}

/// Of the cells that are not blocked (all if it is empty); what stands in blocked ones may be anything.
double sum_of_open(const double* U, const std::vector<uint8_t>& blocked, int cells) {
  constexpr int w = Pack::size;
  Pack packs(0.0);
  int c = 0;
  for (; c + w <= cells; c += w) {
    uint64_t some = 0;
    if (!blocked.empty()) std::memcpy(&some, &blocked[size_t(c)], w);
    Pack u = Pack::load(U + c);
    if (some != 0)
      for (int l = 0; l < w; ++l)
        if (blocked[size_t(c + l)]) u.set(l, 0.0);
    packs += u;
  }
  double sum = 0;
  for (int l = 0; l < w; ++l) sum += packs[l];
  for (; c < cells; ++c)
    if (blocked.empty() || !blocked[size_t(c)]) sum += U[c];
  return sum;
}

}  // namespace

void Books::refresh(const Model& m, const std::vector<int>& blocks) {
  const int cells = m.forest.shape().cells();
  parallel_for_dynamic(int64_t(blocks.size()), [&](int64_t n) {
    const int b = blocks[size_t(n)];
    const std::vector<double> open = open_volumes(m, b);
    const std::vector<uint8_t> blocked = open.empty() ? blocked_cells(m, b) : std::vector<uint8_t>();
    FluidSums sum;
    if (m.forest.shape().radial()) {
      per_block_[size_t(b)] = shells(m, b);
      return;
    }
    const double volume = m.forest.shape(b).cell_volume();
    for (int q = 0; q < m.state.rows(); ++q) {
      const double* U = m.state.block(b, q);
      if (!open.empty())
        for (int c = 0; c < cells; ++c) sum.U[q] += open[size_t(c)] * U[c];
      else
        sum.U[q] = sum_of_open(U, blocked, cells);
    }
    sum.volume = double(blocked.empty() ? cells : std::count(blocked.begin(), blocked.end(), 0));
    if (!open.empty()) sum.volume = std::accumulate(open.begin(), open.end(), 0.0);
    for (double& u : sum.U) u *= volume;
    sum.volume *= volume;
    per_block_[size_t(b)] = sum;
  });
}

FluidSums Books::sums(const Model& m) const {
  FluidSums total;
  // block by block over all ranks, so that the bits do not depend on their number
  std::vector<FluidSums> all = m.forest.comm().size() == 1 ? per_block_ : m.forest.comm().gather_all(per_block_);
  for (const FluidSums& s : all) {
    for (int q = 0; q < m.state.rows(); ++q) total.U[q] += s.U[q];
    total.volume += s.volume;
  }
  return total;
}

SweptSums Books::swept_sums(const Comm& comm) const {
  FixedSum sums[10];
  for (int k = 0; k < most_materials; ++k)
    sums[0] += swept.lost[Cons::arho(k)], sums[1] += swept.made[Cons::arho(k)];
  sums[2] += swept.lost[Cons::rhoE], sums[3] += swept.made[Cons::rhoE];
  for (int d = 0; d < 3; ++d) sums[4 + d] += swept.lost[Cons::mom + d], sums[7 + d] += swept.made[Cons::mom + d];
  FixedSum::sum(comm, sums);
  SweptSums r{sums[0].value(), sums[1].value(), sums[2].value(), sums[3].value(), {}, comm.sum(swept.covered), comm.sum(swept.fresh)};
  for (int d = 0; d < 3; ++d) r.momentum[d] = sums[7 + d].value() - sums[4 + d].value();
  return r;
}

double Books::p_max(const Model& m) const {
  double p = 0;
  for (int b = 0; b < m.forest.local_blocks(); ++b) p = std::max(p, m.state.info[size_t(b)].p_max);
  return m.forest.comm().max(p);
}

Booked Books::booked(const Model& m) const {
  Booked total;
  const auto all = m.forest.comm().size() == 1 ? m.state.booked : m.forest.comm().gather_all(m.state.booked);
  for (const Booked& b : all) total += b;
  return total;
}

}  // namespace bw::cfd
