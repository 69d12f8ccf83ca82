// SPDX-License-Identifier: Apache-2.0
// The two flow models that the block kernel is compiled for: which rows it reconstructs, its predictor and its flux.
#pragma once
#include "cfd/scheme/half_step.h"
#include "cfd/scheme/hllc.h"
#include "cfd/scheme/interface.h"

namespace bw::cfd {

/// Two materials, five-equation model.
struct MixedFlow {
  static constexpr int n = Prim::count, n_flux = Cons::count, v = Prim::v, p = Prim::p;
  static constexpr bool mixed = true;
  Closure closure;
  Interface interface{};

  int prim_row(int q) const { return q; }
  int cons_row(int q) const { return q; }
  /// rho c^2 and dPi of a cell come from its patch rows.
  template <class T>
  static void predict(T (&W)[n], const T (&slope)[3][n], const T (&k)[3], T rho_c2, T dPi) {
    half_step(W, slope, k, rho_c2, dPi);
  }
  template <int axis, class T>
  T flux(const T (&L)[n], const T (&R)[n], const Sound<T>& sound_L, const Sound<T>& sound_R, T (&F)[n_flux]) const {
    return hllc<axis>(L, R, sound_L, sound_R, closure, interface.heaviest, F);
  }
};

/// One material with a constant Pi, in row Prim::arho1 or Prim::arho2.
struct GasFlow {
  static constexpr int n = GasPrim::count, n_flux = GasCons::count, v = GasPrim::v, p = GasPrim::p;
  static constexpr bool mixed = false;
  double over_G, Pi;
  int rho_row;

  int prim_row(int q) const { return q == 0 ? rho_row : Prim::v + q - 1; }
  int cons_row(int q) const { return q == 0 ? rho_row : Cons::mom + q - 1; }
  template <class T>
  static void predict(T (&W)[n], const T (&slope)[3][n], const T (&k)[3], T rho_c2, T) {
    half_step_gas(W, slope, k, rho_c2);
  }
  template <int axis, class T>
  T flux(const T (&L)[n], const T (&R)[n], const Sound<T>& sound_L, const Sound<T>& sound_R, T (&F)[n_flux]) const {
    hllc_gas<axis>(L, R, sound_L.c, sound_R.c, over_G, Pi, F);
    return T(0);
  }
};

}  // namespace bw::cfd
