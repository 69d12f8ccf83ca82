// SPDX-License-Identifier: Apache-2.0
// What a block sees of neighbours at other levels: for each such neighbour a block of its own level, of which the cells
// that serve as ghosts are filled. Finer neighbours are averaged (conserved variables); a coarser one is prolonged with
// limited slopes of primitive variables (cfd/amr/levels.h).
#pragma once
#include <chrono>

#include "cfd/amr/boundary.h"
#include "cfd/amr/levels.h"
#include "cfd/medium.h"
#include "cfd/state.h"

namespace bw::cfd {

/// Adds the seconds of its life to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(std::chrono::steady_clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_;
};

/// One per thread.
class LevelGhosts {
 public:
  /// For a local block that touches other levels; copies of other ranks' blocks are up to date.
  void fill(const Forest& forest, const State& state, const Boundary& boundary, const Medium& medium, int block);
  double seconds = 0;  ///< that this thread has spent on faces between levels

  /// U [variable][k][j][i] of the place at offset d of the last block.
  const double* cells(const std::array<int, 3>& d) const {
    return place_[size_t((d[2] + 1) * 9 + (d[1] + 1) * 3 + d[0] + 1)].data();
  }

 private:
  struct CoarseCell {
    uint64_t made = 0;
    double U[Cons::most], W[Prim::most];
  };
  void restrict_from(const LevelJump& jump, const std::array<int, 3>& offset);
  template <class Mix>
  void prolong_to(const std::array<int, 3>& offset, const Mix& mix);
  template <class Mix>
  const CoarseCell& coarse(const std::array<int, 3>& c, const Mix& mix);
  void make_views();
  template <int rows>
  void read_coarse(std::array<int, 3> c, double* U) const;
  std::vector<double>& place(const std::array<int, 3>& d);

  const Forest* forest_ = nullptr;
  const State* state_ = nullptr;
  const Boundary* boundary_ = nullptr;
  const Medium* medium_ = nullptr;
  int block_ = 0;
  size_t cells_ = 0;
  std::array<std::vector<double>, 27> place_;  ///< made when first needed
  struct View {
    const double* U = nullptr;
    bool finer = false;  ///< the block's own level: means are taken
    std::array<int, 3> scale{}, shift{};
  };
  std::array<View, 27> view_;  ///< by offset, unless the block is at a side of the domain
  bool at_side_ = false;
  Children children_;
  uint64_t pass_ = 0;
  std::vector<CoarseCell> coarse_;  ///< cells of the next coarser level from two before the block to two after it
};

}  // namespace bw::cfd
