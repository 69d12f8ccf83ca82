// SPDX-License-Identifier: Apache-2.0
// The conserved state of all blocks: per block [variable][k][j][i], two copies of each block. A step writes the spare
// copies of the blocks it changes and flips them at the end, so a step can be thrown away, and blocks at rest cost
// nothing.
#pragma once
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "cfd/amr/forest.h"

namespace bw::cfd {

/// What is known of a block without looking at its cells.
struct BlockInfo {
  static constexpr int32_t no_fluid = -1;
  int32_t material = 0;        ///< 1, 2 ...: every open cell holds this material alone; 0: mixed; no_fluid: none is open
  int32_t at_rest = 0;         ///< all cells have the same bits and no momentum
  double rate = 0;             ///< max over cells of sum_d (|v_d| + c)/h_d [1/s]
  double p_max = 0;            ///< Pa, largest of its cells
  double U[Cons::most] = {};   ///< of the block's first cell
};

/// Amounts that entered or left the books otherwise than by fluxes between cells; per block, added up since the start.
struct Booked {
  double side[6][Cons::most] =
      {};  ///< through the sides of the domain, out of lower and into upper: sum of flux dt area
  double cleaned[Cons::most] = {};   ///< removed with traces of a material (alpha < 1e-8)
  double floor_energy = 0;           ///< added where p was below its floor
  double afterburn = 0;              ///< energy released by products that burn on
  int64_t floors = 0;                ///< how often
  int64_t scaled_cells = 0;          ///< cell-steps whose face states were scaled back to stay positive
  int64_t first_order = 0;           ///< cell-steps repeated with first-order fluxes
  int64_t updates = 0;               ///< cell-steps done

  Booked& operator+=(const Booked& b) {
    for (int i = 0; i < 6; ++i)
      for (int q = 0; q < Cons::most; ++q) side[i][q] += b.side[i][q];
    for (int q = 0; q < Cons::most; ++q) cleaned[q] += b.cleaned[q];
    floor_energy += b.floor_energy, afterburn += b.afterburn;
    floors += b.floors, scaled_cells += b.scaled_cells, first_order += b.first_order, updates += b.updates;
    return *this;
  }
};

/// Storage of blocks in pieces of one size, made in bunches and used again.
class BlockPool {
 public:
  explicit BlockPool(size_t doubles) : pitch_((doubles + lanes + 7) / 8 * 8) {}  // packs may hang over the last row
  double* take() {
    if (free_.empty()) grow(16);
    double* piece = free_.back();
    free_.pop_back();
    return piece;
  }
  void give(double* piece) { free_.push_back(piece); }
  /// Makes room for `pieces` more at once, side by side.
  void grow(size_t pieces) {
    bunches_.emplace_back(pieces * pitch_, 0.0);
    for (size_t i = pieces; i-- > 0;) free_.push_back(bunches_.back().data() + i * pitch_);
  }

 private:
  size_t pitch_;
  std::vector<Aligned<double>> bunches_;
  std::vector<double*> free_;
};

class State {
 public:
  explicit State(const Forest& forest, int materials = 2)
      : rows_(Cons::rows(materials)), cells_(size_t(forest.shape().cells())), pool_(block_size()) {
    fit(forest);
  }
  /// Variables of a cell.
  int rows() const { return rows_; }
  size_t block_size() const { return cells_ * size_t(rows_); }
  /// One variable of a block, [k][j][i]; blocks from local_blocks() on are copies of other ranks'.
  const double* block(int b, int variable = 0) const {
    const size_t local = current_.size();
    const double* base = size_t(b) < local ? current_[size_t(b)] : ghosts_.data() + (size_t(b) - local) * block_size();
    return base + size_t(variable) * cells_;
  }
  double* block(int b, int variable = 0) { return const_cast<double*>(std::as_const(*this).block(b, variable)); }
  /// The copy that a step writes.
  double* spare(int b) { return spare_[size_t(b)]; }
  void flip(int b) { std::swap(current_[size_t(b)], spare_[size_t(b)]); }

  /// As many blocks as the forest has now: the first keep what they hold, new ones hold anything.
  void fit(const Forest& forest) {
    const size_t n = size_t(forest.local_blocks());
    for (; current_.size() > n; current_.pop_back()) pool_.give(current_.back());
    for (; spare_.size() > n; spare_.pop_back()) pool_.give(spare_.back());
    if (current_.empty()) pool_.grow(2 * n);
    while (current_.size() < n) current_.push_back(pool_.take());
    while (spare_.size() < n) spare_.push_back(pool_.take());
    ghosts_.assign(size_t(forest.ghost_blocks()) * block_size() + lanes, 0.0);
    info.resize(n + size_t(forest.ghost_blocks()));
    booked.resize(n);
  }
  /// A piece of storage that is no block's yet; arrange() makes it one.
  double* take() { return pool_.take(); }
  /// The blocks' storage from now on, new pieces or those of old blocks; what no block has any more goes back.
  void arrange(const std::vector<double*>& blocks) {
    const std::set<double*> kept(blocks.begin(), blocks.end());
    for (double* old : current_)
      if (!kept.contains(old)) pool_.give(old);
    current_ = blocks;
  }

  double t = 0;  ///< s
  int64_t step = 0;
  std::vector<BlockInfo> info;  ///< [local, then ghosts]
  std::vector<Booked> booked;   ///< [local]
  std::vector<std::vector<double>> outbox, inbox;  ///< [rank] room for exchange_state()

 private:
  int rows_;
  size_t cells_;
  BlockPool pool_;
  std::vector<double*> current_, spare_;  ///< [local]
  Aligned<double> ghosts_;
};

}  // namespace bw::cfd
