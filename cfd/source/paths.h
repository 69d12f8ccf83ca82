// SPDX-License-Identifier: Apache-2.0
// The eikonal |grad s| = 1 in the explosive: s, the shortest way from where it was lit that does not leave it. Straight
// lines where they stay inside, else from corner to corner: a search from cell to cell in which every cell looks back
// to the last corner of its neighbour's way (lazy theta* [Nash, Koenig, Tovey 2010]), so that lengths are those of
// straight pieces, not of steps between cells.
#pragma once
#include <cstdint>

#include "cfd/source/burn.h"

namespace bw::cfd {

/// Cells of the finest level in a box around all explosive.
struct ExplosiveCells {
  Vec3 lower, h;  ///< centre of the first cell, spacing [m]
  std::array<int, 3> n{0, 0, 0};
  std::vector<uint8_t> inside;  ///< [k][j][i] 1: explosive
};

/// The ways to all cells of the box; those outside the explosive follow their neighbours. Empty if no way is longer
/// than a straight line by a cell or more. unreached: explosive cells that no way leads to, which keep straight lines.
WayTable find_ways(const Burn& burn, const ExplosiveCells& cells, int64_t& unreached);

}  // namespace bw::cfd
