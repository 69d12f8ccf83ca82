// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "common/data/field.h"
#include "common/math/tensor.h"

namespace bw::csd {

/// What keeps nodes from following an impulse.
struct Supports {
  std::vector<int32_t> row;  ///< [node] into free; -1: the node is free; later nodes are, too
  std::vector<Mat3> free;    ///< projection on the directions in which the node may move

  Vec3 of(NodeId n, const Vec3& a) const {
    return size_t(n) < row.size() && row[size_t(n)] >= 0 ? free[size_t(row[size_t(n)])] * a : a;
  }
};

}  // namespace bw::csd
