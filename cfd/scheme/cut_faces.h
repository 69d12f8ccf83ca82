// SPDX-License-Identifier: Apache-2.0
// What walls ask of the block kernel: states at the faces of cells that a wall cuts off from a neighbour, made with
// one-sided slopes, and no flux through the faces that a wall shuts. What the wall gives there is added afterwards.
#pragma once
#include <cstdint>
#include <vector>

#include "cfd/amr/patch.h"

namespace bw::cfd {

class CutFaces {
 public:
  /// Nothing given, nothing shut; n: rows of the flow (cfd/scheme/flow_model.h).
  void clear(const BlockShape& shape, int n) {
    n_ = n;
    rows_j_ = shape.n[1] + 2;
    const size_t rows = size_t(shape.n[2] + 2) * size_t(rows_j_);
    for (auto* last : {&last_cell_, &last_shut_[0], &last_shut_[1], &last_shut_[2]}) last->assign(rows, -1);
    cells_.clear(), shut_.clear(), states_.clear();
  }
  /// Cell i of row (k, j), one layer of ghosts among them: W(t + dt/2) and its slopes [d][n]. Until clear().
  void give(int k, int j, int i, const double* half, const double* slope) {
    int32_t& last = last_cell_[row(k, j)];
    cells_.push_back({i, last});
    last = int32_t(cells_.size()) - 1;
    states_.insert(states_.end(), half, half + n_);
    states_.insert(states_.end(), slope, slope + 3 * n_);
  }
  /// The face below cell (k, j, i) along d, which may lie one beyond the block.
  void shut(int d, int k, int j, int i) {
    int32_t& last = last_shut_[d][row(k, j)];
    shut_.push_back({i, last});
    last = int32_t(shut_.size()) - 1;
  }

  /// visit(i, half, slope) for the cells given in a row.
  template <class Visit>
  void for_each_given(int k, int j, const Visit& visit) const {
    for (int32_t c = last_cell_[row(k, j)]; c >= 0; c = cells_[size_t(c)].before) {
      const double* state = &states_[size_t(c) * size_t(4 * n_)];
      visit(cells_[size_t(c)].i, state, state + n_);
    }
  }
  bool any_shut(int d, int k, int j) const { return last_shut_[d][row(k, j)] >= 0; }
  /// visit(i) for the shut faces of a row, some more than once.
  template <class Visit>
  void for_each_shut(int d, int k, int j, const Visit& visit) const {
    for (int32_t c = last_shut_[d][row(k, j)]; c >= 0; c = shut_[size_t(c)].before) visit(shut_[size_t(c)].i);
  }

 private:
  size_t row(int k, int j) const { return size_t(k + 1) * size_t(rows_j_) + size_t(j + 1); }
  struct InRow {
    int32_t i, before;
  };
  int n_ = 0, rows_j_ = 0;
  std::vector<int32_t> last_cell_, last_shut_[3];  ///< [row] into cells_, shut_; -1: none
  std::vector<InRow> cells_, shut_;
  std::vector<double> states_;  ///< [cell][half, slopes]
};

}  // namespace bw::cfd
