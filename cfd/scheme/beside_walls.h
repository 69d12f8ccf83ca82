// SPDX-License-Identifier: Apache-2.0
// What kernels beside walls share with the block kernel: the limits of a cell.
#pragma once
#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

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
