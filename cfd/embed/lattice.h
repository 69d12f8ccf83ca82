// SPDX-License-Identifier: Apache-2.0
// The cell centres of one refinement level, seen as a uniform lattice.
#pragma once
#include <array>
#include <cstdint>

#include "common/math/tensor.h"

namespace bw::cfd {

using Index3 = std::array<int, 3>;

struct Lattice {
  Vec3 lower;         ///< corner of cell (0, 0, 0) [m]
  Vec3 h{1, 1, 1};    ///< cell size per direction [m]
  Index3 n{1, 1, 1};  ///< cells per direction
  /// A direction of one cell carries no flux: the run is 1-D or 2-D there.
  bool active(int d) const { return n[d] > 1; }
  double centre(int d, int i) const { return lower[d] + (i + 0.5) * h[d]; }
  Vec3 centre(const Index3& c) const { return {centre(0, c[0]), centre(1, c[1]), centre(2, c[2])}; }
  friend bool operator==(const Lattice&, const Lattice&) = default;
};

}  // namespace bw::cfd
