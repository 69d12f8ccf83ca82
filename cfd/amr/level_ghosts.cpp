// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/level_ghosts.h"

#include <algorithm>

#include "cfd/amr/levels.h"
#include "common/app/error.h"

namespace bw::cfd {

namespace {
constexpr int apron = 2;  ///< coarse cells around the block: one under the ghosts, one for its slope

/// Cells of the place at an offset that are ghosts of the block: [first, last).
struct Range {
  int first, last;
};
Range ghost_range(const BlockShape& s, int d, int offset) {
  const int n = s.n[size_t(d)];
  return offset < 0 ? Range{n - ghost_layers, n} : offset > 0 ? Range{0, ghost_layers} : Range{0, n};
}
std::array<int, 3> offset_of(int o) { return {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1}; }

}  // namespace

std::vector<double>& LevelGhosts::place(const std::array<int, 3>& d) {
  return place_[size_t((d[2] + 1) * 9 + (d[1] + 1) * 3 + d[0] + 1)];
}

void LevelGhosts::fill(const Forest& forest, const State& state, const Boundary& boundary, const Medium& medium,
                       int block) {
  forest_ = &forest, state_ = &state, boundary_ = &boundary, medium_ = &medium, block_ = block;
  const BlockShape& s = forest.shape();
  cells_ = size_t(s.cells());
  coarse_.resize(size_t((s.n[0] / 2 + 2 * apron) * (s.n[1] / 2 + 2 * apron) * (s.n[2] / 2 + 2 * apron)));
  ++pass_;
  for (int o = 0; o < 27; ++o) {
    const int n = forest.neighbour(block, offset_of(o));
    if (n >= Forest::outside) continue;
    place(offset_of(o)).resize(cells_ * Cons::count + size_t(lanes));
    if (forest.jump(n).finer)
      restrict_from(forest.jump(n), offset_of(o));
    else
      std::visit([&](const auto& mix) { prolong_to(offset_of(o), mix); }, medium.mixture);
  }
}

void LevelGhosts::restrict_from(const LevelJump& jump, const std::array<int, 3>& offset) {
  const BlockShape& s = forest_->shape();
  const Range x = ghost_range(s, 0, offset[0]), y = ghost_range(s, 1, offset[1]), z = ghost_range(s, 2, offset[2]);
  const auto fine = [&](int d, int i) { return s.used[size_t(d)] ? 2 * i : i; };
  double* out = place(offset).data();
  for (int q = 0; q < Cons::count; ++q)
    for (int k = z.first; k < z.last; ++k)
      for (int j = y.first; j < y.last; ++j)
        for (int i = x.first; i < x.last; ++i) {
          const int f[3] = {fine(0, i), fine(1, j), fine(2, k)};
          const int child = (f[0] >= s.n[0]) + 2 * (f[1] >= s.n[1]) + 4 * (f[2] >= s.n[2]);
          out[size_t(q) * cells_ + s.at(k, j, i)] = mean_of_children(state_->block(jump.block[size_t(child)], q), s,
                                                                     f[2] % s.n[2], f[1] % s.n[1], f[0] % s.n[0]);
        }
}

/// U of a cell of the next coarser level, counted from the block's lower corner.
void LevelGhosts::read_coarse(std::array<int, 3> c, double (&U)[Cons::count]) const {
  const BlockShape& s = forest_->shape();
  std::array<int, 3> offset{0, 0, 0};
  bool turned[3] = {false, false, false};
  const double* constant = nullptr;
  for (int d = 2; d >= 0; --d) {
    const size_t e = size_t(d);
    const int half = s.used[e] ? s.n[e] / 2 : 1;
    if (c[e] >= 0 && c[e] < half) continue;
    const bool upper = c[e] >= half;
    if (!forest_->at_side(block_, d, upper)) {
      offset[e] = upper ? 1 : -1;
      continue;
    }
    const BoundarySide& side = boundary_->side[2 * d + upper];
    if (side.kind == SideKind::inflow && !constant) constant = side.U;
    turned[e] = side.kind == SideKind::wall;
    c[e] = turned[e] ? (upper ? 2 * half - 1 - c[e] : -1 - c[e]) : upper ? half - 1 : 0;
  }
  const int n = forest_->neighbour(block_, offset);
  BW_CHECK(constant || n >= 0 || (n < Forest::outside && !forest_->jump(n).finer));
  int at[3];
  for (int d = 0; d < 3; ++d) {
    const size_t e = size_t(d);
    if (!s.used[e])
      at[d] = 0;
    else if (n >= 0)
      at[d] = 2 * c[e] - offset[e] * s.n[e];
    else
      at[d] = c[e] - offset[e] * s.n[e] / 2 + ((forest_->place(block_)[e] + offset[e]) & 1) * s.n[e] / 2;
  }
  for (int q = 0; q < Cons::count; ++q)
    U[q] = constant ? constant[q]
           : n >= 0 ? mean_of_children(state_->block(n, q), s, at[2], at[1], at[0])
                    : state_->block(forest_->jump(n).block[0], q)[s.at(at[2], at[1], at[0])];
  for (int d = 0; d < 3; ++d)
    if (turned[d] && !constant) U[Cons::mom + d] = -U[Cons::mom + d];
}

template <class Mix>
const LevelGhosts::CoarseCell& LevelGhosts::coarse(const std::array<int, 3>& c, const Mix& mix) {
  const BlockShape& s = forest_->shape();
  const size_t wx = size_t(s.n[0] / 2 + 2 * apron), wy = size_t(s.n[1] / 2 + 2 * apron);
  CoarseCell& cell = coarse_[(size_t(c[2] + apron) * wy + size_t(c[1] + apron)) * wx + size_t(c[0] + apron)];
  if (cell.made != pass_) {
    cell.made = pass_;
    read_coarse(c, cell.U);
    mix.to_primitive(cell.U, cell.W, medium_->floors);
  }
  return cell;
}

template <class Mix>
void LevelGhosts::prolong_to(const std::array<int, 3>& offset, const Mix& mix) {
  const BlockShape& s = forest_->shape();
  Range range[3];
  int step[3];
  for (int d = 0; d < 3; ++d) range[d] = ghost_range(s, d, offset[size_t(d)]), step[d] = s.used[size_t(d)] ? 2 : 1;
  double* out = place(offset).data();
  for (int k = range[2].first; k < range[2].last; k += step[2])
    for (int j = range[1].first; j < range[1].last; j += step[1])
      for (int i = range[0].first; i < range[0].last; i += step[0]) {
        const int first[3] = {i, j, k};
        std::array<int, 3> c;
        for (size_t d = 0; d < 3; ++d) c[d] = s.used[d] ? (first[d] + offset[d] * s.n[d]) / 2 : 0;  // even numbers
        const CoarseCell& centre = coarse(c, mix);
        CellSlopes slopes;
        for (int d = 0; d < 3; ++d) {
          if (!s.used[size_t(d)]) continue;
          std::array<int, 3> below = c, above = c;
          --below[size_t(d)], ++above[size_t(d)];
          slopes.set(d, coarse(below, mix).W, centre.W, coarse(above, mix).W);
        }
        for_each_child(s, [&](int, const int(&at)[3], const int(&side)[3]) {
          double U[Cons::count], W[Prim::stored];
          if (slopes.any) {
            slopes.child(centre.W, side, W);
            mix.to_conserved(W, U);
          } else {
            std::copy_n(centre.U, int(Cons::count), U);
          }
          for (int q = 0; q < Cons::count; ++q) out[size_t(q) * cells_ + s.at(k + at[2], j + at[1], i + at[0])] = U[q];
        });
      }
}

}  // namespace bw::cfd
