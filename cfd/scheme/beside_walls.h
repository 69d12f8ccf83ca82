// SPDX-License-Identifier: Apache-2.0
// What kernels do anew that mend a block beside walls after the block kernel: sums over its sides, limits of a cell.
#pragma once
#include <algorithm>

#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

/// For each of `sides` (bit 2d + upper): zero, then add(k, j, i, d, upper, sum) for the cells along it; sum:
/// change.side's rows.
template <class Add>
void sum_sides(const BlockShape& shape, unsigned sides, BlockChange& change, const Add& add) {
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      if (!shape.used[size_t(d)] || !(sides >> (2 * d + upper) & 1)) continue;
      double(&sum)[Cons::most] = change.side[2 * d + upper];
      std::fill(sum, sum + change.rows, 0.0);
      Index3 first{0, 0, 0}, last = shape.n;
      (upper ? first : last)[size_t(d)] = upper ? shape.n[size_t(d)] - 1 : 1;
      for (int k = first[2]; k < last[2]; ++k)
        for (int j = first[1]; j < last[1]; ++j)
          for (int i = first[0]; i < last[0]; ++i) add(k, j, i, d, upper, sum);
    }
}

/// Of the cell at p of the patch: the half step and slopes are cut back where the step wants first order, and face
/// states kept physical. mean: its W.
template <class Flow>
void limit_cell(const Patch& patch, ptrdiff_t p, const Flow& flow, const double (&mean)[Flow::n],
                double (&half)[Flow::n], double (&slope)[3][Flow::n]) {
  if (patch.limited) {
    const double keep = patch.row(Prim::order, 0, 0)[p];
    for (int q = 0; q < Flow::n; ++q) {
      half[q] = mean[q] + keep * (half[q] - mean[q]);
      for (auto& along : slope) along[q] *= keep;
    }
  }
  keep_faces_positive(flow, mean, half, slope);
}

}  // namespace bw::cfd
