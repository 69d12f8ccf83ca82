// SPDX-License-Identifier: Apache-2.0
// The cell centres of one refinement level, seen as a uniform lattice.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
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

/// Which cells have their centre between two planes?
class Centres {
 public:
  explicit Centres(const Lattice& g) {
    for (int d = 0; d < 3; ++d) over_h_[d] = 1 / g.h[d], lower_[d] = g.lower[d], n_[d] = g.n[size_t(d)];
  }
  struct Range {
    int first, last;  ///< first > last: none
    bool empty() const { return first > last; }
  };
  /// lower <= centre <= upper along d, a hair more.
  Range between(int d, double lower, double upper) const {
    constexpr double hair = 1e-9;
    const double n = n_[d];
    return {int(std::clamp(std::ceil((lower - lower_[d]) * over_h_[d] - 0.5 - hair), 0.0, n)),
            int(std::clamp(std::floor((upper - lower_[d]) * over_h_[d] - 0.5 + hair), -1.0, n - 1))};
  }

 private:
  double over_h_[3], lower_[3], n_[3];
};

}  // namespace bw::cfd
