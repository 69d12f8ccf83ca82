// SPDX-License-Identifier: Apache-2.0
// Cure of the carbuncle: HLLC has no dissipation at faces that run along a strong shock, and noise grows there [Quirk
// 1994]. Where a shock crosses the cells of such a face, its linearly degenerate waves (shear and entropy)
// are damped as HLL damps them; everywhere else the flux stays HLLC's. In blocks of one gas only: beside products and
// along burning explosive the same damping made a bent charge diverge.
#pragma once
#include "cfd/amr/patch.h"
#include "cfd/scheme/flow_model.h"

namespace bw::cfd {

inline constexpr double shock_jump = 1;    ///< of p over two cells, of the lower one: a shock crosses the cell
inline constexpr double along_jump = 0.3;  ///< of p across a face, likewise: below it the face runs along the shock

/// Takes the damping from a gas's flux F through a face normal to `axis`; in_shock: 1 where a shock crosses one of its
/// cells.
template <int axis, class Flow, class T>
[[gnu::always_inline]] inline void damp_along_shock(const T (&L)[Flow::n], const T (&R)[Flow::n], T c, T in_shock,
                                                    T (&F)[Flow::n_flux]) {
  constexpr int p = Flow::p, n = Flow::v + axis, t1 = Flow::v + (axis + 1) % 3, t2 = Flow::v + (axis + 2) % 3;
  constexpr int mom = int(GasCons::mom);
  const T along = select(abs(R[p] - L[p]) < T(along_jump) * min(L[p], R[p]), in_shock, T(0));
  const T a = T(0.5) * along * c, mean = T(0.5) * (L[0] + R[0]);
  const T v_n = T(0.5) * (L[n] + R[n]), v_1 = T(0.5) * (L[t1] + R[t1]), v_2 = T(0.5) * (L[t2] + R[t2]);
  const T shear_1 = a * mean * (R[t1] - L[t1]), shear_2 = a * mean * (R[t2] - L[t2]);
  const T mass = a * (R[0] - L[0] - (R[p] - L[p]) / (c * c));
  F[GasCons::rho] -= mass;
  F[mom + axis] -= mass * v_n;
  F[mom + (axis + 1) % 3] -= mass * v_1 + shear_1;
  F[mom + (axis + 2) % 3] -= mass * v_2 + shear_2;
  F[GasCons::rhoE] -= T(0.5) * mass * (v_n * v_n + v_1 * v_1 + v_2 * v_2) + shear_1 * v_1 + shear_2 * v_2;
}

/// Row Prim::shock of a cell that a wall cuts off from a neighbour: nothing is damped at its faces, since the row saw
/// states behind the wall, and the shock before a body would be drawn to it.
inline constexpr double no_damping = -2;
/// Damping at the face between cells with these values of the row: 1 or 0.
template <class T>
T in_shock_between(T low, T high) {
  return max(min(low + high, T(1)), T(0));
}

/// Row Prim::shock of a filled patch, one layer of ghosts; whether a shock crosses any of its cells. Nothing in one
/// dimension.
bool find_shocks(Patch& patch);

}  // namespace bw::cfd
