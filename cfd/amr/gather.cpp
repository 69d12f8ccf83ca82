// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/gather.h"

#include <algorithm>
#include <cstring>

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

void Gather::conserved_row(int block, int k, int j, const int* rows, int count, double* out, int pitch) const {
  const BlockShape& s = forest_.shape();
  const int g = s.ghost(0), n = s.n[0];
  const GhostSource sk = source(block, 2, k), sj = source(block, 1, j);
  if (const double* U = sk.constant ? sk.constant : sj.constant) {
    for (int q = 0; q < count; ++q) std::fill_n(out + q * pitch, n + 2 * g, U[rows[q]]);
    return;
  }
  const size_t row = s.at(sk.index, sj.index, 0);
  const int centre = forest_.neighbour(block, {0, sj.offset, sk.offset});
  for (int q = 0; q < count; ++q) {
    const bool reversed = (rows[q] == Cons::mom_y && sj.mirror) || (rows[q] == Cons::mom_z && sk.mirror);
    const double* from = state_.block(centre, rows[q]) + row;
    double* to = out + q * pitch + g;
    if (reversed)
      for (int i = 0; i < n; ++i) to[i] = -from[i];
    else
      std::memcpy(to, from, size_t(n) * sizeof(double));
  }
  for (int e = 0; e < 2 * g; ++e) {
    const int i = e < g ? e - g : n + e - g;
    const GhostSource si = source(block, 0, i);
    const int b = forest_.neighbour(block, {si.offset, sj.offset, sk.offset});
    for (int q = 0; q < count; ++q) {
      const bool reversed = (rows[q] == Cons::mom && si.mirror) !=
                            ((rows[q] == Cons::mom_y && sj.mirror) || (rows[q] == Cons::mom_z && sk.mirror));
      const double a = si.constant ? si.constant[rows[q]] : state_.block(b, rows[q])[row + size_t(si.index)];
      out[q * pitch + g + i] = reversed && !si.constant ? -a : a;
    }
  }
}

template <class Pair>
void Gather::mixed_rows(int block, Patch& patch, const Pair& pair) const {
  const BlockShape& s = forest_.shape();
  static constexpr int rows[Cons::count] = {0, 1, 2, 3, 4, 5, 6};
  const int g = s.ghost(0), length = s.n[0] + 2 * g, pitch = patch.pitch();
  thread_local Aligned<double> row;
  row.resize(size_t(Cons::count) * pitch);
  for (int k = -s.ghost(2); k < s.n[2] + s.ghost(2); ++k)
    for (int j = -s.ghost(1); j < s.n[1] + s.ghost(1); ++j) {
      conserved_row(block, k, j, rows, Cons::count, row.data(), pitch);
      double* out = patch.row(0, k, j) - g;
      for (int i = 0; i < length; i += Pack::size) {
        Pack U[Cons::count], W[Prim::stored];
        for (int q = 0; q < Cons::count; ++q) U[q] = Pack::load(row.data() + q * pitch + i);
        pair.to_primitive(U, W, medium_.floors);
        for (int q = 0; q < Prim::stored; ++q) W[q].store(out + patch.stride_variable() * q + i);
      }
    }
}

void Gather::gas_rows(int block, Patch& patch, const GasFlow& gas) const {
  const BlockShape& s = forest_.shape();
  int rows[GasCons::count];
  for (int q = 0; q < GasCons::count; ++q) rows[q] = gas.cons_row(q);
  const int g = s.ghost(0), length = s.n[0] + 2 * g, pitch = patch.pitch();
  thread_local Aligned<double> row;
  row.resize(size_t(GasCons::count) * pitch);
  for (int k = -s.ghost(2); k < s.n[2] + s.ghost(2); ++k)
    for (int j = -s.ghost(1); j < s.n[1] + s.ghost(1); ++j) {
      conserved_row(block, k, j, rows, GasCons::count, row.data(), pitch);
      double* out[GasPrim::count];
      for (int q = 0; q < GasPrim::count; ++q) out[q] = patch.row(gas.prim_row(q), k, j) - g;
      double *out_c = patch.row(Prim::c, k, j) - g, *out_rho_c2 = patch.row(Prim::rho_c2, k, j) - g;
      for (int i = 0; i < length; i += Pack::size) {
        Pack U[GasCons::count], W[GasPrim::count], c, rho_c2;
        for (int q = 0; q < GasCons::count; ++q) U[q] = Pack::load(row.data() + q * pitch + i);
        gas_to_primitive(gas, U, W, c, rho_c2, medium_.floors);
        for (int q = 0; q < GasPrim::count; ++q) W[q].store(out[q] + i);
        c.store(out_c + i);
        rho_c2.store(out_rho_c2 + i);
      }
    }
}

void Gather::fill(int block, Patch& patch, bool all_rows) const {
  patch.block = block;
  patch.lower = forest_.lower(block);
  patch.burns = patch.limited = false;
  patch.material = material(block);
  if (patch.material && medium_.is_gas[patch.material - 1] && !all_rows)
    gas_rows(block, patch, medium_.gas[patch.material - 1]);
  else
    std::visit([&](const auto& pair) { mixed_rows(block, patch, pair); }, medium_.mixture);
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
