// SPDX-License-Identifier: Apache-2.0
// A block and two layers of its neighbours as primitive variables.
#pragma once
#include <functional>

#include "cfd/amr/level_ghosts.h"

namespace bw::cfd {

/// Where row or column `index` of a patch comes from.
struct GhostSource {
  int offset = 0;                    ///< -1, 0, 1: which block
  int index = 0;                     ///< row there
  bool mirror = false;               ///< reverse the normal velocity
  const double* constant = nullptr;  ///< inflow: U, instead of a block
};

/// Copies of other ranks' blocks and of what is known of them. Collective.
void exchange_state(const Forest& forest, State& state);

class Gather {
 public:
  Gather(const Forest& forest, const State& state, const Boundary& boundary, const Medium& medium)
      : forest_(forest), state_(state), boundary_(boundary), medium_(medium) {}

  /// Fills patch from the state's current copies. Where the block and its ghosts hold one gas alone, patch.material
  /// says so and only that gas's rows (density, v, p, c, rho_c2) are filled, unless all_rows. space: for neighbours at
  /// other levels.
  void fill(int block, Patch& patch, LevelGhosts& space, bool all_rows = false) const;
  /// Nothing can happen in this block: it and all around it is at rest in the same state.
  bool quiet(int block) const;
  /// Source of cell `index` (-ghosts .. n + ghosts - 1) of a block in direction d.
  GhostSource source(int block, int d, int index) const;
  /// The patch's row Prim::order: 0 where the cell or a neighbour through a face is marked, 1 elsewhere. marks(b):
  /// cells of block b (local or ghost), or nullptr if none is marked.
  void fill_order(int block, const std::function<const uint8_t*(int)>& marks, Patch& patch) const;
  /// 1, 2 ...: the material that a local block and all around it hold alone; 0: several.
  int material(int block) const;

 private:
  void open_sides(int block, bool all_rows, Patch& patch) const;
  /// Every row of the patch: convert(U, W) makes Packs of W[n_W] from those of U[n_U]; U comes from variables cons[],
  /// W goes to patch rows prim[].
  template <int n_U, int n_W, class Convert>
  void fill_rows(int block, Patch& patch, const LevelGhosts& space, const int (&cons)[n_U], const int (&prim)[n_W],
                 const Convert& convert) const;
  bool marked(int block, const std::function<const uint8_t*(int)>& marks, int k, int j, int i) const;

  const Forest& forest_;
  const State& state_;
  const Boundary& boundary_;
  const Medium& medium_;
};

}  // namespace bw::cfd
