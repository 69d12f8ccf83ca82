// SPDX-License-Identifier: Apache-2.0
// Two materials with one velocity and one pressure [Allaire, Clerc, Kokh 2002]; conserved <-> primitive.
//   G = sum alpha_k (1 - b_k rho_k)/Gruneisen_k,  Pi = sum alpha_k (rho_k e_ref,k - p_ref,k/Gruneisen_k),
//   p = (rho e - Pi)/G,  rho c^2 = sum (alpha_k (1 - b_k rho_k)/Gruneisen_k) rho_k c_k^2 / G.
// G is linear in what is conserved, covolumes b included, and so a contact keeps p.
// One material is alpha1 exactly 1 (or 0) and its twin's density exactly 0; nothing here divides by them.
#pragma once
#include <algorithm>

#include "cfd/eos/list.h"
#include "cfd/mix/variables.h"

namespace bw::cfd {

/// What the flow kernels need of the equations of state: all else is in the primitive variables.
struct Closure {
  double over_G1, over_G2;    ///< 1/Gruneisen of the two materials
  double b1_G = 0, b2_G = 0;  ///< b/Gruneisen [m^3/kg]
  /// sum alpha_k (1 - b_k rho_k)/Gruneisen_k
  template <class T>
  T G(T alpha1, T arho1, T arho2) const {
    return over_G2 + alpha1 * (over_G1 - over_G2) - (arho1 * b1_G + arho2 * b2_G);
  }
  /// Of a state at a face.
  template <class T>
  T of(const T* q) const {
    return G(q[Prim::alpha1], q[Prim::arho1], q[Prim::arho2]);
  }
};

inline constexpr double least_free = 1e-3;  ///< of a dense gas: its volume without covolume

/// Below these the state counts as vacuum: p is lifted where it is used. Set from the case (cfd/case.h).
struct Floors {
  double rho = 1e-12;  ///< kg/m^3
  double p = 1e-12;    ///< Pa
};

/// Adds material m at (arho = alpha rho, alpha): sum.dpi takes arho dPi/d(arho).
template <Eos M, class T>
[[gnu::always_inline]] inline void add_material(const M& m, T arho, T alpha, PiTerms<T>& sum) {
  const double over_G = 1 / m.Gruneisen();
  if constexpr (M::constant_reference) {
    const double p_ref = m.reference(1.0).p;  // e_ref is zero for these
    if (p_ref == 0) return;
    sum.pi += alpha * (-p_ref * over_G);
    sum.stiffness += alpha * (-p_ref * over_G);
  } else {
    const Reference<T> r = m.reference(arho / max(alpha, T(1e-100)));
    sum.pi += arho * r.e - alpha * (r.p * over_G);
    sum.stiffness += alpha * ((r.rho_dp - r.p) * over_G - r.rho2_de);
    sum.dpi += arho * r.e + alpha * (r.rho2_de - r.rho_dp * over_G);
  }
}

template <Eos M1, Eos M2>
struct FiveEquation {
  static constexpr int materials = 2, n_cons = Cons::count, n_prim = Prim::stored;
  M1 m1;
  M2 m2;

  Closure closure() const {
    return {1 / m1.Gruneisen(), 1 / m2.Gruneisen(), m1.covolume() / m1.Gruneisen(), m2.covolume() / m2.Gruneisen()};
  }
  /// sum alpha_k (1 - b_k rho_k)/Gruneisen_k of a cell.
  double G(const double* W) const { return closure().G(W[Prim::alpha1], W[Prim::arho1], W[Prim::arho2]); }

  /// Pi, the p-free stiffness and dPi of both materials at (arho_k, alpha1).
  template <class T>
  [[gnu::always_inline]] PiTerms<T> pi_sum(T arho1, T arho2, T alpha1) const {
    PiTerms<T> sum{T(0), T(0), T(0)};
    add_material(m1, arho1, alpha1, sum);
    add_material(m2, arho2, T(1) - alpha1, sum);
    return sum;
  }

  /// W[n_prim] of U[n_cons]. p is lifted to floors.p where it is below; rho to floors.rho in divisions only.
  /// Returns the pressure before the lift.
  template <class T>
  T to_primitive(const T* U, T* W, const Floors& floors) const {
    const T rho = max(U[Cons::arho1] + U[Cons::arho2], T(floors.rho)), over_rho = T(1) / rho;
    const T alpha1 = U[Cons::alpha1], alpha2 = T(1) - alpha1;
    const T vx = U[Cons::mom] * over_rho, vy = U[Cons::mom_y] * over_rho, vz = U[Cons::mom_z] * over_rho;
    const T rho_e = U[Cons::rhoE] - T(0.5) * (U[Cons::mom] * vx + U[Cons::mom_y] * vy + U[Cons::mom_z] * vz);
    const PiTerms<T> s = pi_sum(U[Cons::arho1], U[Cons::arho2], alpha1);
    const Closure c = closure();
    const T G = max(c.G(alpha1, U[Cons::arho1], U[Cons::arho2]), T(least_free * std::min(c.over_G1, c.over_G2))),
            over_G = T(1) / G;
    const T p_raw = (rho_e - s.pi) * over_G, p = max(p_raw, T(floors.p));
    const double g1 = 1 + 1 / m1.Gruneisen(), g2 = 1 + 1 / m2.Gruneisen();
    const T rho_c2 = max((s.stiffness + p * (alpha1 * g1 + alpha2 * g2)) * over_G, T(floors.p));
    W[Prim::arho1] = U[Cons::arho1];
    W[Prim::arho2] = U[Cons::arho2];
    W[Prim::v] = vx;
    W[Prim::v_y] = vy;
    W[Prim::v_z] = vz;
    W[Prim::p] = p;
    W[Prim::alpha1] = alpha1;
    W[Prim::Pi] = s.pi;
    W[Prim::c] = sqrt(rho_c2 * over_rho);
    W[Prim::rho_c2] = rho_c2;
    W[Prim::dPi] = s.dpi;
    return p_raw;
  }

  /// U of arho1, arho2, v, p, alpha1 in W (Pi and what follows are not read).
  template <class T>
  void to_conserved(const T* W, T* U) const {
    const T rho = W[Prim::arho1] + W[Prim::arho2], alpha1 = W[Prim::alpha1];
    U[Cons::arho1] = W[Prim::arho1];
    U[Cons::arho2] = W[Prim::arho2];
    for (int d = 0; d < 3; ++d) U[Cons::mom + d] = rho * W[Prim::v + d];
    const T kinetic =
        T(0.5) * rho * (W[Prim::v] * W[Prim::v] + W[Prim::v_y] * W[Prim::v_y] + W[Prim::v_z] * W[Prim::v_z]);
    U[Cons::rhoE] = closure().G(alpha1, U[Cons::arho1], U[Cons::arho2]) * W[Prim::p] +
                    pi_sum(U[Cons::arho1], U[Cons::arho2], alpha1).pi + kinetic;
    U[Cons::alpha1] = alpha1;
  }

};

}  // namespace bw::cfd
