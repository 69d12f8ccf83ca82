// SPDX-License-Identifier: Apache-2.0
// What a sweep does with its cut cells after all blocks: small ones mix with their neighbours, across blocks and ranks.
#include "cfd/sweep.h"

#include <algorithm>
#include <cmath>

namespace bw::cfd {

void Sweep::mix_cut_cells(State& s) {
  CutCells& cut = *walls_->cut();
  const GasFlow& gas = setup_.medium.gas[0];
  const auto pressure_of = [&](const double* U, double(&W)[GasPrim::stored]) {
    double whole[GasCons::count];
    std::copy_n(U, int(GasCons::count), whole);
    return gas_to_primitive(gas, whole, W, setup_.medium.floors);
  };
  const auto usable_gas = [&](const double* U) {
    double W[GasPrim::stored];
    return pressure_of(U, W) >= setup_.medium.floors.p && U[GasCons::rho] >= setup_.medium.floors.rho;
  };
  cut.mix(forest_.comm(), usable_gas);
  cut_bad_.assign(size_t(forest_.local_blocks()), 0);
  const BlockShape& shape = forest_.finest_shape();
  for (size_t n = 0; n < cut.cells().size(); ++n) {
    const Forest::Cell at = forest_.find_finest(cut.cells()[n].cell);
    if (at.block < 0 || at.block >= forest_.local_blocks() || !(cut.cells()[n].volume1 > 0)) continue;
    const size_t b = size_t(at.block), cell = shape.at(at.k, at.j, at.i);
    const double* U = cut.mean(n);
    for (int q = 0; q < GasCons::count; ++q)
      s.spare(at.block)[size_t(gas.cons_row(q)) * size_t(shape.cells()) + cell] = U[q];
    BlockInfo& info = result_[b].info;
    info.material = 1, info.at_rest = 0;
    if (!usable_gas(U)) {
      if (cut_bad_[b]++ == 0 && result_[b].bad == 0) result_[b].first_bad = int(cell);
      if (marks_[b].empty()) marks_[b].assign(size_t(shape.cells()), 0);
      marks_[b][cell] = 1;
      continue;
    }
    double W[GasPrim::stored], rate = 0;
    info.p_max = std::max(info.p_max, pressure_of(U, W));
    for (int d = 0; d < 3; ++d)
      if (shape.used[size_t(d)]) rate += (std::abs(W[GasPrim::v + d]) + W[GasPrim::c]) / shape.h[d];
    info.rate = std::max(info.rate, rate);
  }
}

}  // namespace bw::cfd
