// SPDX-License-Identifier: Apache-2.0
// Faces between levels: the finer side's fluxes count for both, so that what leaves one block enters the other. Blocks
// step from the finest level down; finer ones leave the means of their fluxes over coarse faces here, coarser ones
// replace their own by them. A finer block at rest leaves nothing: its flux is the coarser one's own.
#pragma once
#include <span>
#include <utility>

#include "cfd/amr/forest.h"
#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

class FluxRegister {
 public:
  /// The forest as it is now; variables of a cell.
  void fit(const Forest& forest, int variables);
  /// Sides of a local block (bit 2 d + upper) beyond which the level changes: BlockChange::keep_sides.
  unsigned sides(int block) const { return sides_[size_t(block)]; }
  /// The block does not step.
  void forget(int block);
  /// Of a block just stepped: what its coarser neighbours will need.
  void record(int block, const BlockChange& change);
  /// Adds to the change of a coarser block the difference to its finer neighbours' fluxes. rows: the variables that its
  /// flow owns.
  void correct(int block, const Patch& patch, std::span<const int> rows, BlockChange& change) const;
  /// Blocks of this level have stepped on all ranks: copies of what others need. Collective.
  void exchange(int level);

 private:
  /// Means over the coarse faces of the block's side in direction d, first to last a row; [0]: were they made?
  double* piece(int block, int d) { return const_cast<double*>(std::as_const(*this).piece(block, d)); }
  const double* piece(int block, int d) const;
  bool made(int block) const;
  void correct_side(int block, int d, int upper, const Patch& patch, std::span<const int> rows,
                    BlockChange& change) const;

  const Forest* forest_ = nullptr;
  int rows_ = 0;                   ///< of a side: fluxes and the face velocity
  size_t size_ = 0;                ///< doubles per block
  std::array<size_t, 3> first_{};  ///< of direction d in them
  std::vector<uint8_t> sides_;     ///< [local]
  std::vector<int> slot_;          ///< [local] -1: no coarser neighbour
  std::vector<double> mine_, ghosts_, none_;
};

}  // namespace bw::cfd
