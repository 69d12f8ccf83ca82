// SPDX-License-Identifier: Apache-2.0
// The state of a cell that the walls have just uncovered or passed over, from connected cells on its own side.
#pragma once
#include "cfd/embed/patch_cuts.h"
#include "cfd/embed/wall_gas.h"

namespace bw::cfd {

/// Least density and pressure of a fresh cell in shares of its neighbour's.
inline constexpr double refill_share = 1e-3;

/// Mean over the directions with a valid neighbour A (open, not fresh, link not cut):
/// - wall on the other side: on the line from the wall's state (half-Riemann of the gas at A, prolonged through B
/// behind it) to A, with
///   weight n_d^2: inside the range of the two;
/// - else the line through B and A prolonged, or A; with a small weight.
/// Composition comes from the neighbour of the largest weight and neighbours like it: nothing is mixed.
/// Returns false if there is no valid neighbour. The patch must hold the cell's surroundings; out: rows of the flow
/// model.
template <class Eos>
bool refill(const Patch& patch, const PatchCuts& cuts, const typename Eos::Flow& flow, const Eos& eos,
            const Index3& cell, typename WallGas<Eos>::State& out) {
  using Gas = WallGas<Eos>;
  using State = typename Gas::State;
  constexpr int n = Gas::n;
  const Gas gas{eos};
  const int c = cuts.at(cell[2], cell[1], cell[0]);
  auto read = [&](Index3 at) {
    State w;
    for (int q = 0; q < n; ++q) w[size_t(q)] = patch.row(flow.prim_row(q), at[2], at[1])[at[0]];
    return w;
  };
  auto valid = [&](int from, int d, int side) {
    const int to = from + (side ? 1 : -1) * cuts.step(d);
    return !cuts.cut(from, d, side) && !cuts.blocked(to) && !cuts.fresh(to);
  };
  State value[6];
  double weight[6], most = 0;
  int count = 0, primary = 0;
  for (int d = 0; d < 3; ++d) {
    if (!cuts.shape().used[size_t(d)]) continue;
    for (int side = 0; side < 2; ++side) {
      if (!valid(c, d, side)) continue;
      const int sign = side ? 1 : -1, a = c + sign * cuts.step(d);
      Index3 at = cell;
      at[size_t(d)] += sign;
      const State A = read(at);
      at[size_t(d)] += sign;
      const int reach = at[size_t(d)], ghost = cuts.shape().ghost(d);
      const bool has_B = reach >= -ghost && reach < cuts.shape().n[size_t(d)] + ghost && valid(a, d, side);
      const State B = has_B ? read(at) : A;
      if (cuts.cut(c, d, 1 - side)) {
        const WallSide& w = cuts.wall(c, d, 1 - side);
        const State star = gas.at_wall(Gas::beyond(A, B, 1 + w.s), w.n, w.v).w;
        value[count] = Gas::on_line(star, A, A, w.s / (1 + w.s));
        weight[count] = 0.01 + w.n[d] * w.n[d];
      } else {
        value[count] = Gas::beyond(A, B, 1);
        weight[count] = 0.005;
      }
      // behind a wall that runs away from its gas: near vacuum, but not less in every next cell
      if (Gas::rho(value[count]) < refill_share * Gas::rho(A))
        for (int q = 0; q < Gas::densities; ++q) value[count][size_t(q)] = refill_share * A[size_t(q)];
      value[count][Gas::p] = std::max(value[count][Gas::p], refill_share * A[Gas::p]);
      if (weight[count] > most) most = weight[count], primary = count;
      ++count;
    }
  }
  if (count == 0) return false;
  State sum{};
  double total = 0;
  for (int i = 0; i < count; ++i) {
    if (!Gas::same_composition(value[i], value[primary])) continue;
    total += weight[i];
    for (size_t q = 0; q < size_t(n); ++q) sum[q] += weight[i] * value[i][q];
  }
  for (size_t q = 0; q < size_t(n); ++q) out[q] = sum[q] / total;
  if constexpr (Eos::Flow::mixed) {
    out[Prim::alpha1] = value[primary][Prim::alpha1];
    out[Prim::Pi] = eos.sum(out).pi;
  }
  return true;
}

}  // namespace bw::cfd
