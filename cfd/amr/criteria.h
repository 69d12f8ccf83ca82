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

struct RefineInput {
  const Forest& forest;
  const State& state;  ///< info of all blocks and the copies of other ranks' are current
  const Boundary& boundary;
  const Medium& medium;
  const Burn* burn;    ///< nullptr: none
  const Walls* walls;  ///< nullptr: none
};

/// Per local block: 1 to split, -1 to join with its siblings, 0. Collective; the same for any number of ranks.
std::vector<int8_t> refine_wishes(const RefineInput& in, const RefineRules& rules);

/// Lohner's indicator at a cell for n = 1 to 3 directions: a[d] below, b here, c[d] above. 0 where the profile is
/// linear, 1 at a jump; ripples below `ripple` of the value do not count.
double refine_indicator(int n, const double (&a)[3], double b, const double (&c)[3]);

}  // namespace bw::cfd
