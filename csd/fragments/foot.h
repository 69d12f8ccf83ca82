// SPDX-License-Identifier: Apache-2.0
// The foot of a perpendicular on a bilinear face.
#pragma once
#include <array>
#include <optional>

#include "common/math/pack.h"
#include "common/math/tensor.h"

namespace bw::csd {

struct Foot {
  std::array<double, 4> N;  ///< of the face's nodes
  Vec3 normal;              ///< outward, of unit length
  double gap;               ///< m, < 0: behind the face
  double size;              ///< m, root of the face's area
};

/// Feet of T's points, each on its own face; T = double or Pack.
template <class T>
struct Feet {
  T found;  ///< 1: there is one, 0: the rest means nothing
  std::array<T, 4> N;
  Vec<T> normal;
  T gap, size;
  Foot of(int lane) const {
    return {{N[0][lane], N[1][lane], N[2][lane], N[3][lane]},
            {normal.x[lane], normal.y[lane], normal.z[lane]},
            gap[lane],
            size[lane]};
  }
};

/// Of a point on a face whose nodes are counter-clockwise seen from outside; the point less its foot is gap * normal.
/// None if it lies beside the face.
template <class T>
Feet<T> feet_on(const Vec<T>& x, const std::array<Vec<T>, 4>& face);

inline std::optional<Foot> foot_on(const Vec3& x, const std::array<Vec3, 4>& face) {
  const Feet<double> f = feet_on(x, face);
  return f.found > 0 ? std::optional(Foot{f.N, f.normal, f.gap, f.size}) : std::nullopt;
}

}  // namespace bw::csd
