// SPDX-License-Identifier: Apache-2.0
// Sums over the sides of a block anew, where walls have changed the fluxes that the block kernel summed.
#pragma once
#include <algorithm>

#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

/// For each of change.book_sides: zero, then add(k, j, i, d, upper, sum) for the cells along it; sum: change.side's
/// rows.
template <class Add>
void sum_sides(const BlockShape& shape, BlockChange& change, const Add& add) {
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      if (!shape.used[size_t(d)] || !(change.book_sides >> (2 * d + upper) & 1)) continue;
      double(&sum)[Cons::most] = change.side[2 * d + upper];
      std::fill(sum, sum + change.rows, 0.0);
      Index3 first{0, 0, 0}, last = shape.n;
      (upper ? first : last)[size_t(d)] = upper ? shape.n[size_t(d)] - 1 : 1;
      for (int k = first[2]; k < last[2]; ++k)
        for (int j = first[1]; j < last[1]; ++j)
          for (int i = first[0]; i < last[0]; ++i) add(k, j, i, d, upper, sum);
    }
}

}  // namespace bw::cfd
