// SPDX-License-Identifier: Apache-2.0
// Where the grid is to be fine: a jump or kink of density or pressure [Lohner 1987], a wall, an explosive that burns, a
// named region.
#pragma once
#include <vector>

#include "cfd/amr/gather.h"
#include "cfd/embed/walls.h"
#include "cfd/regions.h"
#include "cfd/source/burn.h"

namespace bw::cfd {

struct FineRegion {
  RegionShape shape;
  int level = 0;
};

struct RefineRules {
  int every = 4;  ///< steps between two looks
  bool follow_flow = true;
  double refine = 0.3;    ///< indicator in [0, 1] above which a cell asks for the next level
  double coarsen = 0.15;  ///< below which none needs the level it is on
  int buffer = 4;         ///< cells around such a cell that want its level too
  int wall_cells = 8;     ///< of the finest level around each wall that are of the finest level
  std::vector<FineRegion> region;
};

/// Cells of one block that ask for a level, as the box around them; indices of the block, [lower, upper).
struct Asked {
  int level = -1;  ///< -1: none
  std::array<int, 3> lower{}, upper{};
};
/// What the flow in a block asks of the grid in and around it: the next level, and to keep the one it is on.
struct Asks {
  Asked more, same;
};
/// patch: filled, two layers of ghosts; level: its block's, of levels.
Asks asks_of(const Patch& patch, const Medium& medium, const RefineRules& rules, int level, int levels);

struct RefineInput {
  const Forest& forest;
  const State& state;  ///< info of all blocks and the copies of other ranks' are current
  const Boundary& boundary;
  const Medium& medium;
  const Burn* burn;               ///< nullptr: none
  const Walls* walls;             ///< nullptr: none
  const std::vector<Asks>* asks;  ///< [local block], of the last step if it has looked; nullptr: look now
};

/// Per local block: 1 to split, -1 to join with its siblings, 0. Collective; the same for any number of ranks.
std::vector<int8_t> refine_wishes(const RefineInput& in, const RefineRules& rules);

/// The square of Lohner's indicator at a cell for n = 1 to 3 directions: a[d] below, b here, c[d] above. 0 where the
/// profile is linear, 1 at a jump; ripples below `ripple` of the value do not count.
inline constexpr double ripple = 0.02;
template <class T>
T refine_indicator(int n, const T (&a)[3], T b, const T (&c)[3]) {
  T top(0.0), bottom(1e-300);
  for (int d = 0; d < n; ++d) {
    const T second = c[d] - b - (b - a[d]);
    const T scale = abs(c[d] - b) + abs(b - a[d]) + T(ripple) * (abs(c[d]) + T(2.0) * abs(b) + abs(a[d]));
    top += second * second, bottom += scale * scale;
  }
  return top / bottom;
}

}  // namespace bw::cfd
