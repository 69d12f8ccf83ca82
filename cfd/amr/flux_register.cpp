// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/flux_register.h"

namespace bw::cfd {

namespace {
/// The directions along a face of direction d: the faster first.
constexpr int along[3][2] = {{1, 2}, {0, 2}, {0, 1}};
/// Faces of a block's side, and of the coarser level on it, in tangential direction t.
int fine_faces(const BlockShape& s, int d, int t) { return s.n[size_t(along[d][t])]; }
int coarse_faces(const BlockShape& s, int d, int t) {
  return s.used[size_t(along[d][t])] ? fine_faces(s, d, t) / 2 : 1;
}
size_t coarse_count(const BlockShape& s, int d) { return size_t(coarse_faces(s, d, 0) * coarse_faces(s, d, 1)); }
std::array<int, 3> offset_to(int d, int upper) {
  std::array<int, 3> o{0, 0, 0};
  o[size_t(d)] = upper ? 1 : -1;
  return o;
}
}  // namespace

void FluxRegister::fit(const Forest& forest, int variables) {
  rows_ = variables + 1;
  forest_ = &forest;
  const BlockShape& s = forest.shape();
  size_ = 1;
  for (int d = 0; d < 3; ++d) {
    first_[size_t(d)] = size_;
    if (s.used[size_t(d)]) size_ += coarse_count(s, d) * size_t(rows_);
  }
  sides_.assign(size_t(forest.local_blocks()), 0);
  slot_.assign(size_t(forest.local_blocks()), -1);
  int slots = 0;
  for (int b = 0; b < forest.local_blocks(); ++b) {
    if (!forest.at_jump(b)) continue;
    bool coarser = false;
    for (int side = 0; side < 6; ++side) {
      const int n = forest.neighbour(b, offset_to(side / 2, side % 2));
      if (n >= Forest::outside) continue;
      sides_[size_t(b)] |= uint8_t(1u << side);
      coarser = coarser || !forest.jump(n).finer;
    }
    if (coarser) slot_[size_t(b)] = slots++;
  }
  mine_.assign(size_t(slots) * size_, 0.0);
  ghosts_.assign(forest.levels() > 0 ? size_t(forest.ghost_blocks()) * size_ : 0, 0.0);
  none_.assign(size_, 0.0);
}

const double* FluxRegister::piece(int block, int d) const {
  const int local = forest_->local_blocks();
  const double* base =
      block < local ? &mine_[size_t(slot_[size_t(block)]) * size_] : &ghosts_[size_t(block - local) * size_];
  return d < 0 ? base : base + first_[size_t(d)];
}
bool FluxRegister::made(int block) const { return *piece(block, -1) != 0; }

void FluxRegister::forget(int block) {
  if (slot_[size_t(block)] >= 0) *piece(block, -1) = 0;
}

void FluxRegister::record(int block, const BlockChange& change) {
  if (slot_[size_t(block)] < 0) return;
  const BlockShape& s = forest_->shape();
  *piece(block, -1) = 1;
  for (int d = 0; d < 3; ++d) {
    // of the two sides in a direction, one leads to the block's own siblings
    const int side = 2 * d + (forest_->place(block)[size_t(d)] & 1);
    if (!(sides_[size_t(block)] >> side & 1)) continue;
    const int na = fine_faces(s, d, 0), a_n = coarse_faces(s, d, 0), b_n = coarse_faces(s, d, 1);
    const int two_a = na / a_n, two_b = fine_faces(s, d, 1) / b_n;
    double* out = piece(block, d);
    for (int q = 0; q < rows_; ++q) {
      const double* F = change.side_row(side, q);
      for (int b = 0; b < b_n; ++b)
        for (int a = 0; a < a_n; ++a) {
          const double* f = F + two_b * b * na + two_a * a;
          double sum = two_a == 2 ? f[0] + f[1] : f[0];
          if (two_b == 2) sum += two_a == 2 ? f[na] + f[na + 1] : f[na];
          // half: the coarser cell is twice as wide, and dt/h is in the flux
          out[(size_t(q) * size_t(b_n) + size_t(b)) * size_t(a_n) + size_t(a)] = 0.5 * sum / (two_a * two_b);
        }
    }
  }
}

void FluxRegister::correct(int block, const Patch& patch, std::span<const int> owned, BlockChange& change) const {
  for (int side = 0; side < 6; ++side)
    if (sides_[size_t(block)] >> side & 1) correct_side(block, side / 2, side % 2, patch, owned, change);
}

void FluxRegister::correct_side(int block, int d, int upper, const Patch& patch, std::span<const int> owned,
                                BlockChange& change) const {
  const LevelJump& jump = forest_->jump(forest_->neighbour(block, offset_to(d, upper)));
  if (!jump.finer) return;
  const BlockShape& s = forest_->shape();
  const int na = fine_faces(s, d, 0), nb = fine_faces(s, d, 1);
  const int a_n = coarse_faces(s, d, 0), b_n = coarse_faces(s, d, 1);
  const double sign = upper ? -1 : 1;
  const size_t e0 = size_t(along[d][0]), e1 = size_t(along[d][1]);
  for (int b = 0; b < nb; ++b)
    for (int a = 0; a < na; ++a) {
      const bool high_a = s.used[e0] && a >= a_n, high_b = s.used[e1] && b >= b_n;
      const size_t child = (upper ? 0u : size_t(1) << d) + (size_t(high_a) << e0) + (size_t(high_b) << e1);
      const int finer = jump.block[child];
      if (!made(finer)) continue;
      const double* theirs = piece(finer, d) + size_t(b - high_b * b_n) * size_t(a_n) + size_t(a - high_a * a_n);
      const size_t count = coarse_count(s, d);
      const size_t face = size_t(b) * size_t(na) + size_t(a);
      std::array<int, 3> cell;
      cell[size_t(d)] = upper ? s.n[size_t(d)] - 1 : 0;
      cell[e0] = a, cell[e1] = b;
      const auto difference = [&](int q) {
        return theirs[size_t(q) * count] - change.side_row(2 * d + upper, q)[face];
      };
      for (const int q : owned) {
        double by = difference(q);
        if (Cons::is_alpha(q))
          by -= patch.row(Prim::alpha_of(q), cell[2], cell[1])[cell[0]] * difference(change.rows);
        change.row(q, cell[2], cell[1])[cell[0]] += sign * by;
      }
    }
}

void FluxRegister::exchange(int level) {
  if (forest_->levels() == 0) return;
  forest_->exchange(
      size_ * sizeof(double), [&](int b) { return slot_[size_t(b)] >= 0 ? piece(b, -1) : none_.data(); },
      ghosts_.data(), level);
}

}  // namespace bw::cfd
