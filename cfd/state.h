// SPDX-License-Identifier: Apache-2.0
// The conserved state of all blocks: [block][variable][k][j][i], two copies of each block. A step writes the spare
// copies of the blocks it changes and flips them at the end, so a step can be thrown away, and blocks at rest cost
// nothing.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "cfd/amr/forest.h"

namespace bw::cfd {

/// What is known of a block without looking at its cells.
struct BlockInfo {
  int32_t material = 0;        ///< 1 or 2: every cell holds this material alone; 0: mixed
  int32_t at_rest = 0;         ///< all cells have the same bits and no momentum
  double rate = 0;             ///< max over cells of sum_d (|v_d| + c)/h_d [1/s]
  double p_max = 0;            ///< Pa, largest of its cells
  double U[Cons::count] = {};  ///< of the block's first cell
};

/// Amounts that entered or left the books otherwise than by fluxes between cells; per block, added up since the start.
struct Booked {
  double side[6][Cons::count] =
      {};  ///< through the sides of the domain, out of lower and into upper: sum of flux dt area
  double cleaned[Cons::count] = {};  ///< removed with traces of a material (alpha < 1e-8)
  double floor_energy = 0;           ///< added where p was below its floor
  int64_t floors = 0;                ///< how often
  int64_t scaled_cells = 0;          ///< cell-steps whose face states were scaled back to stay positive
  int64_t first_order = 0;           ///< cell-steps repeated with first-order fluxes
  int64_t updates = 0;               ///< cell-steps done

  Booked& operator+=(const Booked& b) {
    for (int i = 0; i < 6; ++i)
      for (int q = 0; q < Cons::count; ++q) side[i][q] += b.side[i][q];
    for (int q = 0; q < Cons::count; ++q) cleaned[q] += b.cleaned[q];
    floor_energy += b.floor_energy;
    floors += b.floors, scaled_cells += b.scaled_cells, first_order += b.first_order, updates += b.updates;
    return *this;
  }
};

class State {
 public:
  explicit State(const Forest& forest)
      : info(size_t(forest.local_blocks() + forest.ghost_blocks())),
        booked(size_t(forest.local_blocks())),
        cells_(size_t(forest.shape().cells())),
        current_(size_t(forest.local_blocks()), 0) {
    const size_t n = size_t(forest.local_blocks()) * block_size();
    for (auto& copy : copies_) copy.assign(n + lanes, 0.0);  // packs may hang over the last row
    ghosts_.assign(size_t(forest.ghost_blocks()) * block_size() + lanes, 0.0);
  }
  size_t block_size() const { return cells_ * Cons::count; }
  /// One variable of a block, [k][j][i]; blocks from local_blocks() on are copies of other ranks'.
  const double* block(int b, int variable = 0) const {
    const size_t local = current_.size();
    const double* base = size_t(b) < local ? copies_[current_[size_t(b)]].data() + size_t(b) * block_size()
                                           : ghosts_.data() + (size_t(b) - local) * block_size();
    return base + size_t(variable) * cells_;
  }
  double* block(int b, int variable = 0) { return const_cast<double*>(std::as_const(*this).block(b, variable)); }
  /// The copy that a step writes.
  double* spare(int b) { return copies_[1 - current_[size_t(b)]].data() + size_t(b) * block_size(); }
  void flip(int b) { current_[size_t(b)] ^= 1; }
  double* ghosts() { return ghosts_.data(); }

  double t = 0;  ///< s
  int64_t step = 0;
  std::vector<BlockInfo> info;  ///< [local, then ghosts]
  std::vector<Booked> booked;   ///< [local]

 private:
  size_t cells_;
  Aligned<double> copies_[2], ghosts_;
  std::vector<uint8_t> current_;  ///< which of the two copies is the state
};

}  // namespace bw::cfd
