// SPDX-License-Identifier: Apache-2.0
#include "cfd/books.h"

#include "common/parallel/loop.h"

namespace bw::cfd {

void Books::refresh(const Model& m, const std::vector<int>& blocks) {
  const int cells = m.forest.shape().cells();
  const double volume = m.forest.shape().cell_volume();
  parallel_for_dynamic(int64_t(blocks.size()), [&](int64_t n) {
    const int b = blocks[size_t(n)];
    const std::vector<uint8_t> blocked = blocked_cells(m, b);
    FluidSums sum;
    std::visit(
        [&](const auto& pair) {
          for (int c = 0; c < cells; ++c) {
            if (!blocked.empty() && blocked[size_t(c)]) continue;
            double U[Cons::count], W[Prim::stored];
            for (int q = 0; q < Cons::count; ++q) sum.U[q] += U[q] = m.state.block(b, q)[c];
            sum.volume += 1;
            pair.to_primitive(U, W, m.setup.medium.floors);
            sum.max_p = std::max(sum.max_p, W[Prim::p]);
          }
        },
        m.setup.medium.mixture);
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
    for (int q = 0; q < Cons::count; ++q) total.U[q] += s.U[q];
    total.volume += s.volume;
    total.max_p = std::max(total.max_p, s.max_p);
  }
  return total;
}

Booked Books::booked(const Model& m) const {
  Booked total;
  const auto all = m.forest.comm().size() == 1 ? m.state.booked : m.forest.comm().gather_all(m.state.booked);
  for (const Booked& b : all) total += b;
  return total;
}

}  // namespace bw::cfd
