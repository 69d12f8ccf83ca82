// SPDX-License-Identifier: Apache-2.0
// Cure of the carbuncle: HLLC has no dissipation at faces that run along a strong shock, and noise grows there [Quirk
// 1994]. Where a shock crosses the cells of such a face, its linearly degenerate waves (shear, and in one gas entropy)
// are damped as HLL damps them; everywhere else the flux stays HLLC's.
#pragma once
#include "cfd/amr/patch.h"
#include "cfd/scheme/flow_model.h"

namespace bw::cfd {

inline constexpr double shock_jump = 1;    ///< of p over two cells, of the lower one: a shock crosses the cell
inline constexpr double along_jump = 0.3;  ///< of p across a face, likewise: below it the face runs along the shock

/// Takes the damping from the flux F through a face normal to `axis`; in_shock: 1 where a shock crosses one of its
/// cells.
template <int axis, class Flow, class T>
[[gnu::always_inline]] inline void damp_along_shock(const T (&L)[Flow::n], const T (&R)[Flow::n], T c, T in_shock,
                                                    T (&F)[Flow::n_flux]) {
  constexpr int p = Flow::p, n = Flow::v + axis, t1 = Flow::v + (axis + 1) % 3, t2 = Flow::v + (axis + 2) % 3;
  constexpr int mom = Flow::mixed ? int(Cons::mom) : int(GasCons::mom),
                rhoE = Flow::mixed ? int(Cons::rhoE) : int(GasCons::rhoE);
  const T along = select(abs(R[p] - L[p]) < T(along_jump) * min(L[p], R[p]), in_shock, T(0));
  T rho_L = L[0], rho_R = R[0];
  if constexpr (Flow::mixed) rho_L += L[Prim::arho2], rho_R += R[Prim::arho2];
  const T a = T(0.5) * along * c, mean = T(0.5) * (rho_L + rho_R);
  const T v_n = T(0.5) * (L[n] + R[n]), v_1 = T(0.5) * (L[t1] + R[t1]), v_2 = T(0.5) * (L[t2] + R[t2]);
  const T shear_1 = a * mean * (R[t1] - L[t1]), shear_2 = a * mean * (R[t2] - L[t2]);
  T mass = a * (rho_R - rho_L - (R[p] - L[p]) / (c * c));
  if constexpr (Flow::mixed) {  // of a gas alone: of others the pressure would feel it
    const auto one_gas = (L[Prim::Pi] >= R[Prim::Pi]) & (L[Prim::Pi] <= R[Prim::Pi]) &
                         (L[Prim::alpha1] >= R[Prim::alpha1]) & (L[Prim::alpha1] <= R[Prim::alpha1]);
    mass = select(one_gas, mass, T(0));
    const T share_1 = (L[Prim::arho1] + R[Prim::arho1]) / (rho_L + rho_R);
    F[Cons::arho1] -= share_1 * mass;
    F[Cons::arho2] -= (T(1) - share_1) * mass;
  } else {
    F[GasCons::rho] -= mass;
  }
  F[mom + axis] -= mass * v_n;
  F[mom + (axis + 1) % 3] -= mass * v_1 + shear_1;
  F[mom + (axis + 2) % 3] -= mass * v_2 + shear_2;
  F[rhoE] -= T(0.5) * mass * (v_n * v_n + v_1 * v_1 + v_2 * v_2) + shear_1 * v_1 + shear_2 * v_2;
}

/// Row Prim::shock of a filled patch, one layer of ghosts, if a shock crosses any of its cells (patch.shocked). Nothing
/// in one dimension.
void find_shocks(Patch& patch);

}  // namespace bw::cfd
