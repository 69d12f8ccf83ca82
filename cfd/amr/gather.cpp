// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/gather.h"

#include <algorithm>
#include <numeric>

#include "cfd/scheme/lane.h"

namespace bw::cfd {

namespace {
int material_of(double alpha1) { return alpha1 == 1.0 ? 1 : alpha1 == 0.0 ? 2 : 0; }
}  // namespace

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
    case SideKind::periodic:
      break;  // periodic sides are never at_side
  }
  return {0, upper ? n - 1 : 0};
}

int Gather::material(int block) const {
  const BlockShape& s = forest_.shape();
  const int m = state_.info[size_t(block)].material;
  if (m == 0) return 0;
  for (int o = 0; o < 27; ++o) {
    const std::array<int, 3> d{o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
    if ((d[0] && !s.used[0]) || (d[1] && !s.used[1]) || (d[2] && !s.used[2])) continue;
    const int b = forest_.neighbour(block, d);
    if (b >= 0 && state_.info[size_t(b)].material != m) return 0;
  }
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      const BoundarySide& side = boundary_.side[2 * d + upper];
      if (side.kind == SideKind::inflow && s.used[d] && forest_.at_side(block, d, upper) &&
          material_of(side.U[Cons::alpha1]) != m)
        return 0;
    }
  return m;
}

bool Gather::quiet(int block) const {
  const BlockShape& s = forest_.shape();
  const BlockInfo& mine = state_.info[size_t(block)];
  if (!mine.at_rest) return false;
  for (int o = 0; o < 27; ++o) {
    const std::array<int, 3> d{o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
    if ((d[0] && !s.used[0]) || (d[1] && !s.used[1]) || (d[2] && !s.used[2])) continue;
    const int b = forest_.neighbour(block, d);
    if (b < 0) continue;
    const BlockInfo& other = state_.info[size_t(b)];
    if (!other.at_rest || !std::equal(mine.U, mine.U + Cons::count, other.U)) return false;
  }
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      const BoundarySide& side = boundary_.side[2 * d + upper];
      if (side.kind == SideKind::inflow && s.used[d] && forest_.at_side(block, d, upper) &&
          !std::equal(mine.U, mine.U + Cons::count, side.U))
        return false;
    }
  return true;
}

template <int n_U, int n_W, class Convert>
void Gather::fill_rows(int block, Patch& patch, const int (&cons)[n_U], const int (&prim)[n_W],
                       const Convert& convert) const {
  constexpr int w = Pack::size;
  const BlockShape& s = forest_.shape();
  const int g = s.ghost(0), n = s.n[0];
  GhostSource ends[2 * ghost_layers];
  for (int e = 0; e < 2 * g; ++e) ends[e] = source(block, 0, e < g ? e - g : n + e - g);
  for (int k = -s.ghost(2); k < s.n[2] + s.ghost(2); ++k) {
    const GhostSource sk = source(block, 2, k);
    for (int j = -s.ghost(1); j < s.n[1] + s.ghost(1); ++j) {
      const GhostSource sj = source(block, 1, j);
      const double* constant = sk.constant ? sk.constant : sj.constant;
      const size_t row = s.at(sk.index, sj.index, 0);
      const int centre = forest_.neighbour(block, {0, sj.offset, sk.offset});
      const double* from[n_U];
      bool reversed[n_U];
      double* out[n_W];
      for (int q = 0; q < n_U; ++q) {
        from[q] = constant ? nullptr : state_.block(centre, cons[q]) + row;
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
      if (g == 0) continue;
      double end_U[n_U][2 * ghost_layers + w], end_W[n_W][2 * ghost_layers + w];
      for (int e = 0; e < 2 * g; ++e) {
        const double* fixed = constant ? constant : ends[e].constant;
        const int b = fixed ? centre : forest_.neighbour(block, {ends[e].offset, sj.offset, sk.offset});
        for (int q = 0; q < n_U; ++q) {
          const double u = fixed ? fixed[cons[q]] : state_.block(b, cons[q])[row + size_t(ends[e].index)];
          const bool turned = !fixed && reversed[q] != (cons[q] == Cons::mom && ends[e].mirror);
          end_U[q][e] = turned ? -u : u;
        }
      }
      for (int e = 0; e < 2 * g; e += w) {
        Pack U[n_U], W[n_W];
        for (int q = 0; q < n_U; ++q) U[q] = Pack::load(end_U[q] + e);
        convert(U, W);
        for (int q = 0; q < n_W; ++q) W[q].store(end_W[q] + e);
      }
      for (int q = 0; q < n_W; ++q) {
        std::copy_n(end_W[q], ghost_layers, out[q] - ghost_layers);
        std::copy_n(end_W[q] + ghost_layers, ghost_layers, out[q] + n);
      }
    }
  }
}

void Gather::fill(int block, Patch& patch, bool all_rows) const {
  patch.block = block;
  patch.lower = forest_.lower(block);
  patch.burns = patch.limited = false;
  patch.material = material(block);
  if (patch.material && medium_.is_gas[patch.material - 1] && !all_rows) {
    const GasFlow& gas = medium_.gas[patch.material - 1];
    int cons[GasCons::count], prim[GasPrim::stored];
    for (int q = 0; q < GasCons::count; ++q) cons[q] = gas.cons_row(q);
    for (int q = 0; q < GasPrim::count; ++q) prim[q] = gas.prim_row(q);
    prim[GasPrim::c] = Prim::c;
    prim[GasPrim::rho_c2] = Prim::rho_c2;
    fill_rows(block, patch, cons, prim, [&](const Pack(&U)[GasCons::count], Pack(&W)[GasPrim::stored]) {
      gas_to_primitive(gas, U, W, medium_.floors);
    });
    return;
  }
  int cons[Cons::count], prim[Prim::stored];
  std::iota(cons, cons + Cons::count, 0);
  std::iota(prim, prim + Prim::stored, 0);
  std::visit(
      [&](const auto& pair) {
        fill_rows(block, patch, cons, prim, [&](const Pack(&U)[Cons::count], Pack(&W)[Prim::stored]) {
          pair.to_primitive(U, W, medium_.floors);
        });
      },
      medium_.mixture);
}

void Gather::fill_order(int block, const std::function<const uint8_t*(int)>& marks, Patch& patch) const {
  const BlockShape& s = forest_.shape();
  const int g[3] = {s.ghost(0), s.ghost(1), s.ghost(2)};
  const auto marked = [&](int k, int j, int i) {
    const GhostSource sk = source(block, 2, k), sj = source(block, 1, j), si = source(block, 0, i);
    if (sk.constant || sj.constant || si.constant) return false;
    const uint8_t* m = marks(forest_.neighbour(block, {si.offset, sj.offset, sk.offset}));
    return m && m[s.at(sk.index, sj.index, si.index)];
  };
  for (int k = -g[2] / 2; k < s.n[2] + g[2] / 2; ++k)
    for (int j = -g[1] / 2; j < s.n[1] + g[1] / 2; ++j)
      for (int i = -g[0] / 2; i < s.n[0] + g[0] / 2; ++i) {
        bool near = marked(k, j, i);
        for (int d = 0; d < 3 && !near; ++d)
          if (s.used[d])
            near = marked(k - (d == 2), j - (d == 1), i - (d == 0)) || marked(k + (d == 2), j + (d == 1), i + (d == 0));
        patch.row(Prim::order, k, j)[i] = near ? 0.0 : 1.0;
      }
  patch.limited = true;
}

}  // namespace bw::cfd
