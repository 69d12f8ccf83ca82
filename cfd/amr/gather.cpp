// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/gather.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "cfd/amr/levels.h"
#include "cfd/amr/open_side.h"
#include "cfd/scheme/lane.h"
#include "common/parallel/loop.h"

namespace bw::cfd {

void exchange_state(const Forest& forest, State& s) {
  if (forest.comm().size() == 1) return;
  static_assert(sizeof(BlockInfo) % sizeof(double) == 0);
  constexpr size_t info = sizeof(BlockInfo) / sizeof(double);
  const size_t rows = size_t(s.rows());
  const BlockShape& shape = forest.shape();
  // of each piece its cells, then what is known of the block
  const auto place = [&](const Piece& p, size_t number) { return p.start * rows + number * info; };
  const auto for_each_row = [&](const Piece& p, double* at, const auto& body) {
    const size_t n = size_t(p.last[0] - p.first[0]);
    for (int q = 0; q < s.rows(); ++q)
      for (int k = p.first[2]; k < p.last[2]; ++k)
        for (int j = p.first[1]; j < p.last[1]; ++j, at += n) body(s.block(p.block, q) + shape.at(k, j, p.first[0]), at, n);
    return at;
  };
  const size_t ranks = size_t(forest.comm().size());
  s.outbox.resize(ranks), s.inbox.resize(ranks);
  const auto size_of = [&](const std::vector<Piece>& list) {
    return list.empty() ? 0 : place(list.back(), list.size()) + list.back().cells() * rows;
  };
  for (size_t r = 0; r < ranks; ++r) {
    const std::vector<Piece>& list = forest.pieces_to(int(r));
    s.outbox[r].resize(size_of(list)), s.inbox[r].resize(size_of(forest.pieces_from(int(r))));
    parallel_for_dynamic(int64_t(list.size()), [&](int64_t i) {
      const Piece& p = list[size_t(i)];
      double* end = for_each_row(p, s.outbox[r].data() + place(p, size_t(i)),
                                 [](const double* cell, double* at, size_t n) { std::copy_n(cell, n, at); });
      std::memcpy(end, &s.info[size_t(p.block)], sizeof(BlockInfo));
    });
  }
  forest.comm().exchange(s.outbox, s.inbox);
  for (size_t r = 0; r < ranks; ++r) {
    const std::vector<Piece>& list = forest.pieces_from(int(r));
    parallel_for_dynamic(int64_t(list.size()), [&](int64_t i) {
      const Piece& p = list[size_t(i)];
      const double* end = for_each_row(p, s.inbox[r].data() + place(p, size_t(i)),
                                       [](double* cell, const double* at, size_t n) { std::copy_n(at, n, cell); });
      std::memcpy(static_cast<void*>(&s.info[size_t(p.block)]), end, sizeof(BlockInfo));
    });
  }
}

GhostSource Gather::source(int block, int d, int index) const {
  const int n = forest_.shape().n[d];
  if (index >= 0 && index < n) return {0, index};
  const bool upper = index >= n;
  if (!forest_.at_side(block, d, upper)) return {upper ? 1 : -1, upper ? index - n : index + n};
  const BoundarySide& side = boundary_.side[2 * d + upper];
  switch (side.kind) {
    case SideKind::wall:
      return {0, upper ? 2 * n - 1 - index : -1 - index, true};
    case SideKind::inflow:
      return {0, 0, false, side.U};
    case SideKind::outflow:
    case SideKind::far_field:        // fill_open_side() makes them
    case SideKind::subsonic_inflow:  // of copies
    case SideKind::periodic:
      break;  // periodic sides are never at_side
  }
  return {0, upper ? n - 1 : 0};
}

int Gather::material(int block) const {
  const BlockShape& s = forest_.shape();
  const int m = state_.info[size_t(block)].material;
  if (m <= 0) return 0;
  for (int b : forest_.around(block))
    if (const int other = state_.info[size_t(b)].material; other != m && other != BlockInfo::no_fluid) return 0;
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      const BoundarySide& side = boundary_.side[2 * d + upper];
      if (side.has_state() && s.used[d] && forest_.at_side(block, d, upper) &&
          medium_.material_of(side.U) != m)
        return 0;
    }
  return m;
}

bool Gather::quiet(int block) const {
  const BlockShape& s = forest_.shape();
  const BlockInfo& mine = state_.info[size_t(block)];
  if (!mine.at_rest) return false;
  for (int b : forest_.around(block)) {
    const BlockInfo& other = state_.info[size_t(b)];
    if (!other.at_rest || !std::equal(mine.U, mine.U + state_.rows(), other.U)) return false;
  }
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      const BoundarySide& side = boundary_.side[2 * d + upper];
      if (side.has_state() && s.used[d] && forest_.at_side(block, d, upper) &&
          !std::equal(mine.U, mine.U + state_.rows(), side.U))
        return false;
    }
  return true;
}

namespace {
/// Ghosts by their layer beyond the block along each direction, 0 within: slopes of the first layer ask for those at
/// edges whose layers are 2 in all, interpolation between cells around a point for the first at corners.
bool used_by_stencils(int x, int y, int z) { return x + y + z <= ghost_layers || std::max({x, y, z}) <= 1; }
}  // namespace

template <int n_U, int n_W, class Convert>
void Gather::fill_rows(int block, Patch& patch, const LevelGhosts& space, const int (&cons)[n_U],
                       const int (&prim)[n_W], const Convert& convert) const {
  constexpr int w = Pack::size;
  const BlockShape& s = forest_.shape();
  const int g = s.ghost(0), n = s.n[0];
  const size_t variable = size_t(s.cells());
  const auto cells = [&](const std::array<int, 3>& offset) {
    const int b = forest_.neighbour(block, offset);
    return b >= 0 ? state_.block(b) : space.cells(offset);
  };
  GhostSource ends[2 * ghost_layers];
  for (int e = 0; e < 2 * g; ++e) ends[e] = source(block, 0, e < g ? e - g : n + e - g);
  // ghosts at the ends of rows are converted a pack at a time, some rows' together
  double end_U[n_U][w];
  int waiting = 0;
  double* place[w];  // row 0 of the patch
  const auto convert_ends = [&] {
    Pack U[n_U], W[n_W];
    for (int q = 0; q < n_U; ++q) U[q] = Pack::load(end_U[q]);
    convert(U, W);
    for (int q = 0; q < n_W; ++q)
      for (int l = 0; l < waiting; ++l) place[l][prim[q] * patch.stride_variable()] = W[q][l];
    waiting = 0;
  };
  for (auto& u : end_U) std::fill(u, u + w, 1.0);
  const auto wanted = [&](int x, int y, int z) { return patch.whole || used_by_stencils(x, y, z); };
  const auto beyond = [&](int d, int i) { return i < 0 ? -i : std::max(i - s.n[size_t(d)] + 1, 0); };
  for (int k = -s.ghost(2); k < s.n[2] + s.ghost(2); ++k) {
    const GhostSource sk = source(block, 2, k);
    for (int j = -s.ghost(1); j < s.n[1] + s.ghost(1); ++j) {
      const int layers[2] = {beyond(1, j), beyond(2, k)};
      if (!wanted(0, layers[0], layers[1])) continue;
      const GhostSource sj = source(block, 1, j);
      const double* constant = sk.constant ? sk.constant : sj.constant;
      const size_t row = s.at(sk.index, sj.index, 0);
      const double* const centre = constant ? nullptr : cells({0, sj.offset, sk.offset}) + row;
      const double* from[n_U];
      bool reversed[n_U];
      double* out[n_W];
      for (int q = 0; q < n_U; ++q) {
        from[q] = constant ? nullptr : centre + size_t(cons[q]) * variable;
        reversed[q] = !constant && ((cons[q] == Cons::mom_y && sj.mirror) || (cons[q] == Cons::mom_z && sk.mirror));
      }
      for (int q = 0; q < n_W; ++q) out[q] = patch.row(prim[q], k, j);
      for (int i = 0; i < n; i += w) {
        Pack U[n_U], W[n_W];
        for (int q = 0; q < n_U; ++q) {
          U[q] = constant ? Pack(constant[cons[q]]) : Pack::load(from[q] + i);
          if (reversed[q]) U[q] = -U[q];
        }
        convert(U, W);
        for (int q = 0; q < n_W; ++q) W[q].store(out[q] + i);
      }
      for (int e = 0; e < 2 * g; ++e) {
        const int i = e < g ? e - g : n + e - g;
        if (!wanted(beyond(0, i), layers[0], layers[1])) continue;
        const double* fixed = constant ? constant : ends[e].constant;
        const double* base =
            fixed ? nullptr : cells({ends[e].offset, sj.offset, sk.offset}) + row + size_t(ends[e].index);
        for (int q = 0; q < n_U; ++q) {
          const double u = fixed ? fixed[cons[q]] : base[size_t(cons[q]) * variable];
          const bool turned = !fixed && reversed[q] != (cons[q] == Cons::mom && ends[e].mirror);
          end_U[q][waiting] = turned ? -u : u;
        }
        place[waiting++] = patch.row(0, k, j) + i;
        if (waiting == w) convert_ends();
      }
    }
  }
  if (waiting > 0) convert_ends();
}

void Gather::fill(int block, Patch& patch, LevelGhosts& space, bool all_rows) const {
  patch.block = block;
  patch.lower = forest_.lower(block);
  patch.set_cell_size(forest_.shape(block).h);
  patch.burns = patch.limited = patch.shocked = false;
  patch.material = material(block);
  if (forest_.at_jump(block)) space.fill(forest_, state_, boundary_, medium_, block);
  if (patch.material && medium_.is_gas[patch.material - 1] && !all_rows) {
    const GasFlow& gas = medium_.gas[patch.material - 1];
    int cons[GasCons::count], prim[GasPrim::stored];
    for (int q = 0; q < GasCons::count; ++q) cons[q] = gas.cons_row(q);
    for (int q = 0; q < GasPrim::count; ++q) prim[q] = gas.prim_row(q);
    prim[GasPrim::c] = Prim::c;
    prim[GasPrim::rho_c2] = Prim::rho_c2;
    fill_rows(block, patch, space, cons, prim, [&](const Pack(&U)[GasCons::count], Pack(&W)[GasPrim::stored]) {
      gas_to_primitive(gas, U, W, medium_.floors);
    });
    open_sides(block, all_rows, patch);
    return;
  }
  std::visit(
      [&]<class Mix>(const Mix& mix) {
        constexpr int further = Prim::stored, n_W = further + (Mix::n_prim - Prim::two_rows) * (Mix::materials > 2);
        int cons[Mix::n_cons], prim[n_W];
        std::iota(cons, cons + Mix::n_cons, 0);
        std::iota(prim, prim + further, 0);
        std::iota(prim + further, prim + n_W, int(Prim::two_rows));
        fill_rows(block, patch, space, cons, prim, [&](const Pack(&U)[Mix::n_cons], Pack(&W)[n_W]) {
          if constexpr (Mix::materials == 2) {
            mix.to_primitive(U, W, medium_.floors);
          } else {
            Pack all[Mix::n_prim];
            mix.to_primitive(U, all, medium_.floors);
            for (int q = 0; q < n_W; ++q) W[q] = all[prim[q]];
          }
        });
      },
      medium_.mixture);
  open_sides(block, all_rows, patch);
}

void Gather::open_sides(int block, bool all_rows, Patch& patch) const {
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper)
      if (const BoundarySide& side = boundary_.side[2 * d + upper];
          is_open(side.kind) && patch.shape().used[size_t(d)] && forest_.at_side(block, d, upper))
        fill_open_side(medium_, side, d, upper, all_rows, patch);
}

/// Is the cell marked that (k, j, i) of the patch stands for, or one of the finer ones under it?
bool Gather::marked(int block, const std::function<const uint8_t*(int)>& marks, int k, int j, int i) const {
  const BlockShape& s = forest_.shape();
  const GhostSource source_of[3] = {source(block, 0, i), source(block, 1, j), source(block, 2, k)};
  std::array<int, 3> offset, at;
  for (int d = 0; d < 3; ++d) {
    if (source_of[d].constant) return false;
    offset[size_t(d)] = source_of[d].offset, at[size_t(d)] = source_of[d].index;
  }
  const int b = forest_.neighbour(block, offset);
  if (b >= 0) {
    const uint8_t* m = marks(b);
    return m && m[s.at(at[2], at[1], at[0])];
  }
  const LevelJump& jump = forest_.jump(b);
  if (!jump.finer) {
    const uint8_t* m = marks(jump.block[0]);
    for (size_t d = 0; d < 3; ++d)
      if (s.used[d]) at[d] = at[d] / 2 + ((forest_.place(block)[d] + offset[d]) & 1) * s.n[d] / 2;
    return m && m[s.at(at[2], at[1], at[0])];
  }
  size_t child = 0;
  for (size_t d = 0; d < 3; ++d)
    if (s.used[d] && 2 * at[d] >= s.n[d]) child += size_t(1) << d;
  const uint8_t* m = marks(jump.block[child]);
  bool any = false;
  for_each_child(s, [&](int, const int(&o)[3], const int(&)[3]) {
    const auto fine = [&](size_t d) { return s.used[d] ? 2 * at[d] % s.n[d] + o[d] : 0; };
    any = any || (m && m[s.at(fine(2), fine(1), fine(0))]);
  });
  return any;
}

void Gather::fill_order(int block, const std::function<const uint8_t*(int)>& marks, Patch& patch) const {
  const BlockShape& s = forest_.shape();
  const int g[3] = {s.ghost(0), s.ghost(1), s.ghost(2)};
  const auto is_marked = [&](int k, int j, int i) { return marked(block, marks, k, j, i); };
  for (int k = -g[2] / 2; k < s.n[2] + g[2] / 2; ++k)
    for (int j = -g[1] / 2; j < s.n[1] + g[1] / 2; ++j)
      for (int i = -g[0] / 2; i < s.n[0] + g[0] / 2; ++i) {
        bool near = is_marked(k, j, i);
        for (int d = 0; d < 3 && !near; ++d)
          if (s.used[d])
            near = is_marked(k - (d == 2), j - (d == 1), i - (d == 0)) ||
                   is_marked(k + (d == 2), j + (d == 1), i + (d == 0));
        patch.row(Prim::order, k, j)[i] = near ? 0.0 : 1.0;
      }
  patch.limited = true;
}

}  // namespace bw::cfd
