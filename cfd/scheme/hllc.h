// SPDX-License-Identifier: Apache-2.0
// HLLC [Toro 10.4-10.6] for the five-equation model and for one gas, in the form F = u_f U_f + p_f (0, n, u_f): the
// upwind state is the star state between the waves and the side's own state outside. At a contact at rest every product
// is exactly zero.
#pragma once
#include "cfd/mix/five_equation.h"
#include "cfd/scheme/half_step.h"

namespace bw::cfd {

/// The waves of a face: the side upwind of the contact and what happens to it.
template <class T>
struct Waves {
  T v;         ///< normal velocity at the face: the contact's, or the side's own where the flow is supersonic
  T p;         ///< pressure at the face
  T compress;  ///< rho_f/rho of the upwind side
  T work;      ///< E_f - compress E: energy per volume gained between the side and the star state
};
/// c belongs to the cell; rho to the face, but see strength().
template <class T>
struct Side {
  T rho, v, p, c;
};
/// What a face needs of the cell on one side besides the state at the face.
template <class T>
struct Sound {
  T c, rho;
};

/// Density that sets the strength of a side's waves, rho c. It has to go with the stiffness rho c^2 of its cell: in a
/// cell with some air in dense explosive the face may be a thousand times lighter than the mean, and any noise would
/// grow. Where faces of light cells may be heavy (sharp interfaces), heaviest limits them likewise, over the cell's
/// rho.
template <class T>
T strength(T rho_face, const Sound<T>& cell, double heaviest) {
  return min(max(rho_face, T(0.5) * cell.rho), heaviest * cell.rho);
}

/// from_left is set to the mask "upwind is left". Davis' wave speeds with the cells' sound speeds.
template <class T, class M>
[[gnu::always_inline]] inline Waves<T> waves(const Side<T>& L, const Side<T>& R, M& from_left) {
  const T S_L = min(L.v - L.c, R.v - R.c), S_R = max(L.v + L.c, R.v + R.c);
  const T m_L = L.rho * (S_L - L.v), m_R = R.rho * (S_R - R.v);
  const T v_star = L.v + (R.p - L.p + m_R * (L.v - R.v)) / (m_L - m_R);  // Toro 10.37, exact where L and R agree
  from_left = v_star >= T(0);
  const T S = select(from_left, S_L, S_R), m = select(from_left, m_L, m_R);
  const T v = select(from_left, L.v, R.v), p = select(from_left, L.p, R.p);
  const T p_star = p + m * (v_star - v);       // Toro 10.36
  const T outside = select(from_left, S, -S);  // >= 0: the whole fan lies on the other side of the face
  const auto supersonic = outside >= T(0);
  const T compress = (S - v) / (S - v_star);
  const T work = (p_star * v_star - p * v) / (S - v_star);  // Toro 10.39 without the density
  return {select(supersonic, v, v_star), select(supersonic, p, p_star), select(supersonic, T(1), compress),
          select(supersonic, T(0), work)};
}

/// Density of a state at a face.
template <class T, int n>
[[gnu::always_inline]] inline T density_of(const T (&q)[n]) {
  T rho = q[Prim::arho1] + q[Prim::arho2];
  for (int m = 2; FaceRow::rows(m) < n; ++m) rho += q[FaceRow::arho(m)];
  return rho;
}

/// Flux of two or more materials through a face normal to `axis`; returns the face velocity that the alpha equation needs:
/// d alpha/dt = -(F[alpha1]_+ - F[alpha1]_-)/h + alpha (v_f+ - v_f-)/h.
/// L, R: states at the face (FaceRow); heaviest: see strength().
template <int axis, class T, int n_W, int n_flux, class C>
[[gnu::always_inline]] inline T hllc(const T (&L)[n_W], const T (&R)[n_W], const Sound<T>& sound_L,
                                     const Sound<T>& sound_R, const C& closure, double heaviest, T (&F)[n_flux]) {
  constexpr int n = Prim::v + axis, t1 = Prim::v + (axis + 1) % 3, t2 = Prim::v + (axis + 2) % 3;
  decltype(L[0] >= R[0]) left;
  const Waves<T> w =
      waves<T>({strength(density_of(L), sound_L, heaviest), L[n], L[Prim::p], sound_L.c},
               {strength(density_of(R), sound_R, heaviest), R[n], R[Prim::p], sound_R.c}, left);
  T q[n_W];
  for (int i = 0; i < n_W; ++i) q[i] = select(left, L[i], R[i]);
  const T rho = density_of(q);
  const T E = closure.of(q) * q[Prim::p] + q[Prim::Pi] +
              T(0.5) * rho * (q[n] * q[n] + q[t1] * q[t1] + q[t2] * q[t2]);
  const T flow = w.compress * w.v;
  F[Cons::arho1] = q[Prim::arho1] * flow;
  F[Cons::arho2] = q[Prim::arho2] * flow;
  T mass = F[Cons::arho1] + F[Cons::arho2];
  for (int f = Cons::count; f < n_flux; ++f) {
    F[f] = q[f + 1] * (Cons::is_alpha(f) ? w.v : flow);  // FaceRow holds them in the same order
    if (!Cons::is_alpha(f)) mass += F[f];
  }
  F[Cons::mom + axis] = mass * w.v + w.p;
  F[Cons::mom + (axis + 1) % 3] = mass * q[t1];
  F[Cons::mom + (axis + 2) % 3] = mass * q[t2];
  F[Cons::rhoE] = E * flow + (w.work + w.p) * w.v;
  F[Cons::alpha1] = q[Prim::alpha1] * w.v;
  return w.v;
}

/// Rows of a gas flux.
struct GasCons {
  enum : int { rho, mom, mom_y, mom_z, rhoE, count };
};

/// The same for one material of constant Pi (0 for an ideal gas).
template <int axis, class T>
[[gnu::always_inline]] inline void hllc_gas(const T (&L)[GasPrim::count], const T (&R)[GasPrim::count], T c_L, T c_R,
                                            double over_G, double Pi, T (&F)[GasCons::count]) {
  constexpr int n = GasPrim::v + axis, t1 = GasPrim::v + (axis + 1) % 3, t2 = GasPrim::v + (axis + 2) % 3;
  decltype(c_L >= c_R) left;
  const Waves<T> w =
      waves<T>({L[GasPrim::rho], L[n], L[GasPrim::p], c_L}, {R[GasPrim::rho], R[n], R[GasPrim::p], c_R}, left);
  T q[GasPrim::count];
  for (int i = 0; i < GasPrim::count; ++i) q[i] = select(left, L[i], R[i]);
  const T E = over_G * q[GasPrim::p] + Pi + T(0.5) * q[GasPrim::rho] * (q[n] * q[n] + q[t1] * q[t1] + q[t2] * q[t2]);
  const T flow = w.compress * w.v;
  F[GasCons::rho] = q[GasPrim::rho] * flow;
  F[GasCons::mom + axis] = F[GasCons::rho] * w.v + w.p;
  F[GasCons::mom + (axis + 1) % 3] = F[GasCons::rho] * q[t1];
  F[GasCons::mom + (axis + 2) % 3] = F[GasCons::rho] * q[t2];
  F[GasCons::rhoE] = E * flow + (w.work + w.p) * w.v;
}

}  // namespace bw::cfd
