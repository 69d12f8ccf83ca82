// SPDX-License-Identifier: Apache-2.0
#include "cfd/scheme/carbuncle.h"

#include <algorithm>

#include "cfd/scheme/lane.h"

namespace bw::cfd {

bool find_shocks(Patch& patch) {
  const BlockShape& s = patch.shape();
  if (int(s.used[0]) + s.used[1] + s.used[2] < 2) return false;
  bool found = false;
  const ptrdiff_t step[3] = {1, patch.stride_j(), patch.stride_k()};
  const int g[3] = {s.used[0], s.used[1], s.used[2]};
  for (int k = -g[2]; k < s.n[2] + g[2]; ++k)
    for (int j = -g[1]; j < s.n[1] + g[1]; ++j) {
      const bool in_k = k >= 0 && k < s.n[2], in_j = j >= 0 && j < s.n[1];
      if (!in_k && !in_j) continue;  // no face is there
      const int x = in_k && in_j ? g[0] : 0;
      const double* p = patch.row(Prim::p, k, j);
      double* out = patch.row(Prim::shock, k, j);
      for (int i = -x; i < s.n[0] + x; i += Pack::size) {
        Pack jump(0.0);
        for (int d = 0; d < 3; ++d) {
          if (!s.used[size_t(d)]) continue;
          const Pack low = Pack::load(p + i - step[d]), high = Pack::load(p + i + step[d]);
          jump = max(jump, abs(high - low) - Pack(shock_jump) * min(low, high));
        }
        const auto in = jump > Pack(0.0);
        select(in, Pack(1.0), Pack(0.0)).store(out + i);
        for (int l = 0; l < std::min(Pack::size, s.n[0] + x - i); ++l) found = found || in[l];
      }
    }
  return found;
}

}  // namespace bw::cfd
