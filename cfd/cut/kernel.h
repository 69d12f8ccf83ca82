// SPDX-License-Identifier: Apache-2.0
// The step of a block with cut cells in it (cells.h), one gas. The block kernel runs as if there were no walls; cells
// that listed cells meet are done again here:
//
//   slopes      least squares over the connected cells around, from centroid to centroid, limited along the grid
//   predictor   Hancock's, at the centroid
//   cell faces  HLLC between the lines' values at the centroid of the open part, times that part
//   facets      p* of half a Riemann problem at the facet's centroid against the wall's velocity there: gives the wall
//               p* area, and the gas's energy p* v . area
//
// Listed cells get their content (integral of U), all others their change.
#pragma once
#include <optional>
#include <vector>

#include "cfd/cut/cells.h"
#include "cfd/embed/cut_scheme.h"
#include "cfd/embed/wall_gas.h"

namespace bw::cfd {

class CutCellKernel {
 public:
  static constexpr int n = GasFlow::n;
  using State = std::array<double, size_t(n)>;
  using Gas = WallGas<GasAtWall>;

  explicit CutCellKernel(const BlockShape& shape);

  /// After BlockKernel::advance with the same patch, flow and dt. U: the block's state, [variable][cell]. skipped:
  /// [cell] set to 1 in cells whose end of step CutCells makes, and in closed ones. exchange and links are added to.
  void correct(const Patch& patch, const GasFlow& flow, double dt, const Index3& first_cell, const double* U,
               CutCells& cells, const GhostRules& rules, BlockChange& change, WallExchange& exchange,
               std::vector<LinkLoad>& links, std::vector<uint8_t>& skipped);

 private:
  enum : int32_t { plain = -1, beyond = -2, closed = -3 };
  struct Cell {
    int c;        ///< number in the patch
    ptrdiff_t p;  ///< offset in the patch's rows
    Index3 at;    ///< in the block
  };
  struct Predicted {
    State half;
    double slope[3][n];
    Vec3 centre;  ///< where `half` holds, in cell sizes from the cell's lower corner
    bool special;
  };
  using Flux = std::array<double, GasCons::count>;

  Cell cell_at(int k, int j, int i) const {
    return {((k + g_[2]) * e_[1] + (j + g_[1])) * e_[0] + (i + g_[0]), k * stride_[2] + j * stride_[1] + i, {i, j, k}};
  }
  Cell moved(const Cell& x, int d, int by) const {
    Cell y = x;
    y.c += by * step_[d], y.p += by * stride_[d], y.at[size_t(d)] += by;
    return y;
  }
  State read(const Cell& x) const {
    State w;
    for (int q = 0; q < n; ++q) w[size_t(q)] = row_[q][x.p];
    return w;
  }
  const CutCell* listed(const Cell& x) const {
    return slot_[size_t(x.c)] >= 0 ? &cells_->cells()[size_t(slot_[size_t(x.c)])] : nullptr;
  }
  double volume(const Cell& x) const;
  double open(const Cell& low, int d) const;
  bool in_patch(const Cell& x, int margin) const;

  void look_up(const Index3& first_cell);
  void mark();
  const Predicted& predicted(const Cell& x);
  void slopes_on_grid(const Cell& x, Predicted& r) const;
  void slopes_of_squares(const Cell& x, Predicted& r) const;
  bool borrow(const Cell& x, Predicted& r) const;
  State on_lines(const Predicted& own, const Vec3& at) const;
  Flux face(const Cell& low, const Cell& high, int d, bool upper);
  void finish(const Cell& x, const double* U, const Flux& sum, const GasFlow& flow);
  void book_sides(BlockChange& change);

  BlockShape shape_;
  int g_[3] = {}, e_[3] = {}, step_[3] = {};
  ptrdiff_t stride_[3] = {};
  double lambda_[3] = {}, half_lambda_[3] = {}, dt_ = 0;
  const Patch* patch_ = nullptr;
  const GasFlow* flow_ = nullptr;
  CutCells* cells_ = nullptr;
  GhostRules rules_{};
  std::optional<Gas> gas_;
  const double* row_[n] = {};
  WallExchange* exchange_ = nullptr;
  std::vector<LinkLoad>* links_ = nullptr;
  std::vector<int32_t> slot_;     ///< [patch cell] place in cells(), or plain, beyond, closed
  std::vector<uint8_t> special_;  ///< [patch cell] slopes by least squares
  std::vector<int32_t> known_;    ///< [patch cell] into predicted_, -1: not yet
  std::vector<Predicted> predicted_;
};

}  // namespace bw::cfd
