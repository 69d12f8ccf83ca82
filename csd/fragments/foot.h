// SPDX-License-Identifier: Apache-2.0
// The foot of a perpendicular on a bilinear face.
#pragma once
#include <array>
#include <optional>

#include "common/math/tensor.h"

namespace bw::csd {

struct Foot {
  std::array<double, 4> N;  ///< of the face's nodes
  Vec3 normal;              ///< outward, of unit length
  double gap;               ///< m, < 0: behind the face
  double size;              ///< m, root of the face's area
};

/// Of a point on a face whose nodes are counter-clockwise seen from outside; the point less its foot is gap * normal.
/// Nothing if it lies beside the face.
std::optional<Foot> foot_on(const Vec3& x, const std::array<Vec3, 4>& face);

}  // namespace bw::csd
