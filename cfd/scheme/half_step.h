// SPDX-License-Identifier: Apache-2.0
// Hancock's predictor: primitive variables of a cell half a step later, from its own slopes [Toro 14.4, FLUID model].
//   W(t + dt/2) = W - dt/2 sum_d A_d(W) dW_d/h_d
#pragma once
#include "cfd/mix/variables.h"
#include "common/math/pack.h"

namespace bw::cfd {

/// W[Prim::count] of two materials; slope[d] are undivided differences over the cell; k[d] = dt/(2 h_d), 0 in unused
/// directions. rho_c2 and dPi are the cell's (Prim). Pi: dPi/dt + v.grad Pi = -arho_k dPi/d(arho_k) div v.
template <class T>
void half_step(T (&W)[Prim::count], const T (&slope)[3][Prim::count], const T (&k)[3], T rho_c2, T dPi) {
  const T vx = k[0] * W[Prim::v], vy = k[1] * W[Prim::v_y], vz = k[2] * W[Prim::v_z];
  const T div = k[0] * slope[0][Prim::v] + k[1] * slope[1][Prim::v_y] + k[2] * slope[2][Prim::v_z];
  const T over_rho = T(1) / (W[Prim::arho1] + W[Prim::arho2]);
  const T compress[Prim::count] = {W[Prim::arho1] * div,
                                   W[Prim::arho2] * div,
                                   k[0] * slope[0][Prim::p] * over_rho,
                                   k[1] * slope[1][Prim::p] * over_rho,
                                   k[2] * slope[2][Prim::p] * over_rho,
                                   rho_c2 * div,
                                   T(0),
                                   dPi * div};
  for (int q = 0; q < Prim::count; ++q)
    W[q] = W[q] - (vx * slope[0][q] + vy * slope[1][q] + vz * slope[2][q] + compress[q]);
}

/// The same of more than two materials, W[FaceRow::rows(K)].
template <int K, class T, int n>
void half_step_many(T (&W)[n], const T (&slope)[3][n], const T (&k)[3], T rho_c2, T dPi) {
  const T vx = k[0] * W[Prim::v], vy = k[1] * W[Prim::v_y], vz = k[2] * W[Prim::v_z];
  const T div = k[0] * slope[0][Prim::v] + k[1] * slope[1][Prim::v_y] + k[2] * slope[2][Prim::v_z];
  T rho(0), compress[n];
  for (T& c : compress) c = T(0);
  for (int m = 0; m < K; ++m) {
    rho += W[FaceRow::arho(m)];
    compress[FaceRow::arho(m)] = W[FaceRow::arho(m)] * div;
  }
  const T over_rho = T(1) / rho;
  for (int d = 0; d < 3; ++d) compress[Prim::v + d] = k[d] * slope[d][Prim::p] * over_rho;
  compress[Prim::p] = rho_c2 * div;
  compress[Prim::Pi] = dPi * div;
  for (int q = 0; q < n; ++q)
    W[q] = W[q] - (vx * slope[0][q] + vy * slope[1][q] + vz * slope[2][q] + compress[q]);
}

/// Rows of one gas: rho, v[3], p are reconstructed; c and rho_c2 belong to cell centres.
struct GasPrim {
  enum : int { rho, v, v_y, v_z, p, count, c = count, rho_c2, stored };
};

/// The same for one material of constant Pi.
template <class T>
void half_step_gas(T (&W)[GasPrim::count], const T (&slope)[3][GasPrim::count], const T (&k)[3], T rho_c2) {
  const T vx = k[0] * W[GasPrim::v], vy = k[1] * W[GasPrim::v_y], vz = k[2] * W[GasPrim::v_z];
  const T div = k[0] * slope[0][GasPrim::v] + k[1] * slope[1][GasPrim::v_y] + k[2] * slope[2][GasPrim::v_z];
  const T over_rho = T(1) / W[GasPrim::rho];
  const T compress[GasPrim::count] = {W[GasPrim::rho] * div, k[0] * slope[0][GasPrim::p] * over_rho,
                                      k[1] * slope[1][GasPrim::p] * over_rho, k[2] * slope[2][GasPrim::p] * over_rho,
                                      rho_c2 * div};
  for (int q = 0; q < GasPrim::count; ++q)
    W[q] = W[q] - (vx * slope[0][q] + vy * slope[1][q] + vz * slope[2][q] + compress[q]);
}

}  // namespace bw::cfd
