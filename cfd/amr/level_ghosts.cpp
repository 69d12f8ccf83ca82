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
  const Stopwatch watch(seconds);
  forest_ = &forest, state_ = &state, boundary_ = &boundary, medium_ = &medium, block_ = block;
  const BlockShape& s = forest.shape();
  cells_ = size_t(s.cells());
  coarse_.resize(size_t((s.n[0] / 2 + 2 * apron) * (s.n[1] / 2 + 2 * apron) * (s.n[2] / 2 + 2 * apron)));
  ++pass_;
  children_ = children_of(s);
  make_views();
  for (int o = 0; o < 27; ++o) {
    const int n = forest.neighbour(block, offset_of(o));
    if (n >= Forest::outside) continue;
    place(offset_of(o)).resize(state.block_size() + size_t(lanes));
    if (forest.jump(n).finer)
      restrict_from(forest.jump(n), offset_of(o));
    else
      std::visit([&](const auto& mix) { prolong_to(offset_of(o), mix); }, medium.mixture);
  }
}

void LevelGhosts::restrict_from(const LevelJump& jump, const std::array<int, 3>& offset) {
  const BlockShape& s = forest_->shape();
  const Range x = ghost_range(s, 0, offset[0]), y = ghost_range(s, 1, offset[1]), z = ghost_range(s, 2, offset[2]);
  const int by[3] = {s.used[0] ? 2 : 1, s.used[1] ? 2 : 1, s.used[2] ? 2 : 1};
  double* out = place(offset).data();
  for (int k = z.first; k < z.last; ++k)
    for (int j = y.first; j < y.last; ++j) {
      const int fj = by[1] * j, fk = by[2] * k;
      for (int i = x.first; i < x.last;) {  // the part of the row in one child
        const int high = by[0] * i >= s.n[0], end = high ? x.last : std::min(x.last, s.n[0] / by[0]);
        const int block = jump.block[size_t(high + 2 * (fj >= s.n[1]) + 4 * (fk >= s.n[2]))];
        for (int q = 0; q < state_->rows(); ++q) {
          const double* U = state_->block(block, q);
          double* row = out + size_t(q) * cells_ + s.at(k, j, 0);
          for (int c = i; c < end; ++c)
            row[c] = mean_of_children(U, s, fk % s.n[2], fj % s.n[1], by[0] * c - high * s.n[0]);
        }
        i = end;
      }
    }
}

/// Where the cells of the next coarser level lie that are at an offset from the block.
void LevelGhosts::make_views() {
  const BlockShape& s = forest_->shape();
  at_side_ = false;
  for (int d = 0; d < 3; ++d)
    at_side_ =
        at_side_ || (s.used[size_t(d)] && (forest_->at_side(block_, d, false) || forest_->at_side(block_, d, true)));
  if (at_side_) return;
  for (int o = 0; o < 27; ++o) {
    const std::array<int, 3> offset = offset_of(o);
    const int n = forest_->neighbour(block_, offset);
    View& v = view_[size_t(o)];
    v = {};
    if (n == Forest::outside) continue;
    v.finer = n >= 0;
    if (!v.finer && forest_->jump(n).finer) continue;
    v.U = state_->block(v.finer ? n : forest_->jump(n).block[0]);
    for (size_t d = 0; d < 3; ++d) {
      v.scale[d] = s.used[d] ? (v.finer ? 2 : 1) : 0;
      v.shift[d] = !s.used[d] ? 0
                   : v.finer  ? -offset[d] * s.n[d]
                              : (((forest_->place(block_)[d] + offset[d]) & 1) - offset[d]) * s.n[d] / 2;
    }
  }
}

/// U of a cell of the next coarser level, counted from the block's lower corner.
template <int rows>
void LevelGhosts::read_coarse(std::array<int, 3> c, double* U) const {
  const BlockShape& s = forest_->shape();
  std::array<int, 3> offset{0, 0, 0};
  if (!at_side_) {
    for (size_t d = 0; d < 3; ++d)
      if (s.used[d]) offset[d] = c[d] < 0 ? -1 : c[d] >= s.n[d] / 2 ? 1 : 0;
    const View& v = view_[size_t((offset[2] + 1) * 9 + (offset[1] + 1) * 3 + offset[0] + 1)];
    const int i = v.scale[0] * c[0] + v.shift[0], j = v.scale[1] * c[1] + v.shift[1],
              k = v.scale[2] * c[2] + v.shift[2];
    for (int q = 0; q < rows; ++q) {
      const double* u = v.U + size_t(q) * cells_;
      U[q] = v.finer ? mean_of_children(u, s, k, j, i) : u[s.at(k, j, i)];
    }
    return;
  }
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
  for (int q = 0; q < rows; ++q)
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
    read_coarse<Mix::n_cons>(c, cell.U);
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
        CellSlopes<Mix::materials> slopes;
        for (int d = 0; d < 3; ++d) {
          if (!s.used[size_t(d)]) continue;
          std::array<int, 3> below = c, above = c;
          --below[size_t(d)], ++above[size_t(d)];
          slopes.set(d, coarse(below, mix).W, centre.W, coarse(above, mix).W);
        }
        const size_t here = s.at(k, j, i);
        for (int first_child = 0; first_child < children_.count; first_child += Pack::size) {
          Pack U[Mix::n_cons], W[Mix::n_prim];
          if (slopes.any) {
            slopes.children(centre.W, children_, first_child, W);
            mix.to_conserved(W, U);
          } else {
            for (int q = 0; q < Mix::n_cons; ++q) U[q] = Pack(centre.U[q]);
          }
          for (int q = 0; q < Mix::n_cons; ++q) {
            double* to = out + size_t(q) * cells_ + here;
            for (int l = 0; l < std::min(Pack::size, children_.count - first_child); ++l)
              to[children_.cells[first_child + l]] = U[q][l];
          }
        }
      }
}

}  // namespace bw::cfd
