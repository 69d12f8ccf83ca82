// SPDX-License-Identifier: Apache-2.0
// What a motion (or a crack) does to cells: covered, uncovered, or passed over by a wall thinner than a cell.
#pragma once
#include <vector>

#include "cfd/embed/cut_map.h"
#include "coupling/surface.h"

namespace bw::cfd {

/// Cells whose centre a face passed over while its nodes moved straight from x_before to surface.x; sorted, each once.
/// Includes a few that a wall only touched: refilling those does no harm.
std::vector<Index3> swept_cells(const coupling::WetSurface& surface, const std::vector<Vec3>& x_before,
                                const Lattice& lattice);

struct FreshCell {
  Index3 cell;
  int layer;                ///< 1: has a connected neighbour with valid fluid; 2: a neighbour of layer 1 ...
  bool held_fluid = false;  ///< before the motion: the wall passed over it
};
struct Changes {
  std::vector<Index3> covered;   ///< held fluid before, in metal now
  std::vector<FreshCell> fresh;  ///< to be refilled, by layers
  int layers = 0;
  int64_t sealed = 0;  ///< open cells that no fluid reaches: they stay without fluid until it does
};

/// Compares the map before a change with the one after, and marks fresh and sealed cells in the latter.
Changes compare(const CutMap& before, CutMap& now, const std::vector<Index3>& swept);

}  // namespace bw::cfd
