// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/open_side.h"

#include <algorithm>
#include <cmath>

namespace bw::cfd {
namespace {

using State = double[Prim::most];

/// How far the incoming wave goes from the last cell's (0: the copy) to the given state's (1), times the domain's
/// cells across: the copy alone lets the mean drift; the given state's is wrong behind a shock, whose incoming wave is
/// not that of the gas at rest. So the mean is drawn back over some passages of the domain, however fine its cells: K =
/// sigma c/L with sigma = 0.3 [Rudy & Strikwerda 1980: 0.27; Poinsot & Lele 1992: 0.25].
constexpr double drawn_back = 0.6;

double density(int materials, const State& W) {
  double rho = W[Prim::arho1] + W[Prim::arho2];
  for (int k = 2; k < materials; ++k) rho += W[Prim::arho(k)];
  return rho;
}

/// arho, v, p, alpha of the ghosts; what follows from them is left alone.
void ghost_state(const BoundarySide& side, int materials, const State& last, const State& given, int d, double sign,
                 double h, const Floors& floors, State& out) {
  const double z = density(materials, last) * last[Prim::c], c = last[Prim::c],
               u = sign * last[Prim::v + d], u_f = sign * given[Prim::v + d];
  const bool inflow = side.kind == SideKind::subsonic_inflow;
  std::copy(last, last + Prim::most, out);
  if (!inflow && u >= c) return;
  if (inflow || u < 0) std::copy(given, given + Prim::most, out);
  if (inflow) {
    out[Prim::p] = std::max(last[Prim::p] + z * (u - u_f), floors.p);
    return;
  }
  if (u <= -c) return;
  const double share = std::min(drawn_back * h / side.across, 0.3);
  const double p = last[Prim::p], drawn = std::max(p + 0.5 * share * (given[Prim::p] - p + z * (u - u_f)), floors.p);
  out[Prim::v + d] = sign * (u + (p - drawn) / z);
  if (u >= 0)  // along the isentrope of the gas that leaves
    for (int k = 0; k < std::max(materials, 2); ++k) out[Prim::arho(k)] *= std::max(1 + (drawn - p) / (c * z), 0.1);
  out[Prim::p] = drawn;
}

}  // namespace

void fill_open_side(const Medium& medium, const BoundarySide& side, int d, bool upper, bool all_rows, Patch& patch) {
  const BlockShape& s = patch.shape();
  State given = {};
  std::visit([&](const auto& mix) { mix.to_primitive(side.U, given, medium.floors); }, medium.mixture);
  const int materials = medium.count(), rows = Prim::rows(materials);
  const auto is_state = [](int q) { return q < Prim::stored || q >= Prim::two_rows; };
  const int m = patch.material;
  const bool gas = m != 0 && medium.is_gas[m - 1] && !all_rows;
  const int a = (d + 1) % 3, b = (d + 2) % 3;
  for (int y = 0; y < s.n[size_t(b)]; ++y)
    for (int x = 0; x < s.n[size_t(a)]; ++x) {
      int at[3];
      at[a] = x, at[b] = y;
      const auto cell = [&](int q) -> double& { return patch.row(q, at[2], at[1])[at[0]]; };
      at[d] = upper ? s.n[size_t(d)] - 1 : 0;
      State last = {}, out;
      for (int q = 0; q < rows; ++q) {
        if (!is_state(q)) continue;
        const bool filled = !gas || q == medium.gas[m - 1].rho_row || (q >= Prim::v && q <= Prim::p) || q == Prim::c ||
                            q == Prim::rho_c2;
        if (filled) last[q] = cell(q);
      }
      if (gas && (materials > 2 || m == 1)) last[Prim::alpha(m - 1)] = 1;
      // in the given state already: copies of the last cell are it, to the last bit
      bool same = true;
      for (int q = 0; q <= Prim::alpha1; ++q) same = same && last[q] == given[q];
      for (int k = 2; k < materials; ++k) same = same && last[Prim::arho(k)] == given[Prim::arho(k)];
      if (same) continue;
      ghost_state(side, materials, last, given, d, upper ? 1 : -1, s.h[d], medium.floors, out);
      double U[Cons::most];
      State W;
      std::visit(
          [&](const auto& pair) {
            pair.to_conserved(out, U);
            pair.to_primitive(U, W, medium.floors);
          },
          medium.mixture);
      for (int layer = 1; layer <= ghost_layers; ++layer) {
        at[d] = upper ? s.n[size_t(d)] - 1 + layer : -layer;
        for (int q = 0; q < rows; ++q)
          if (is_state(q)) cell(q) = W[q];
      }
    }
}

}  // namespace bw::cfd
