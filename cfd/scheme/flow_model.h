// SPDX-License-Identifier: Apache-2.0
// The flow models that the block kernel is compiled for: which rows it reconstructs, its predictor and its flux.
#pragma once
#include <array>

#include "cfd/mix/many_materials.h"
#include "cfd/scheme/half_step.h"
#include "cfd/scheme/hllc.h"
#include "cfd/scheme/interface.h"

namespace bw::cfd {

/// Two materials, five-equation model.
struct MixedFlow {
  static constexpr int n = Prim::count, n_flux = Cons::count, v = Prim::v, p = Prim::p;
  static constexpr bool mixed = true;
  static constexpr int materials = 2;
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

/// sum alpha_k (1 - b_k rho_k)/Gruneisen_k of more than two materials at a face.
template <int K>
struct ManyClosure {
  std::array<double, K> over_G{}, b_G{};
  template <class T>
  T of(const T* q) const {
    T sum(0);
    for (int k = 0; k < K; ++k)
      sum += q[FaceRow::alpha(k)] * T(over_G[size_t(k)]) - q[FaceRow::arho(k)] * T(b_G[size_t(k)]);
    return sum;
  }
};

/// More than two materials.
template <int K>
struct ManyFlow {
  static constexpr int n = FaceRow::rows(K), n_flux = Cons::rows(K), v = Prim::v, p = Prim::p;
  static constexpr bool mixed = true;
  static constexpr int materials = K;
  ManyClosure<K> closure;
  std::array<double, K> Pi{};    ///< of materials whose Pi is constant
  std::array<bool, K> curved{};  ///< the others

  ManyFlow() = default;
  explicit ManyFlow(const ManyMaterials<K>& mix) : closure{mix.over_G, mix.b_G} {
    for (size_t k = 0; k < K; ++k) {
      curved[k] = std::visit([](const auto& m) { return !m.constant_reference; }, mix.form[k]);
      if (!curved[k]) Pi[k] = mix.part(int(k), 0.0, 1.0).pi;
    }
  }
  int prim_row(int q) const { return FaceRow::prim(q); }
  int cons_row(int q) const { return q; }
  /// Slopes limited one by one do not add up. Of the volume fractions that rise and those that fall the stronger lot is
  /// scaled back until all stay 1 together, densities and parts of Pi with their material's fraction: a contact of any
  /// materials keeps p and v. slope: of one direction; part(k): the limited slope of row Prim::part(k).
  template <class T, class Part>
  [[gnu::always_inline]] void balance(T (&slope)[n], const Part& part) const {
    const T none(0), one(1);
    T rise(0), fall(0);
    for (int k = 0; k < K; ++k) {
      rise += max(slope[FaceRow::alpha(k)], none);
      fall += max(-slope[FaceRow::alpha(k)], none);
    }
    const T most = max(rise, fall), share = min(rise, fall) / max(most, T(1e-300));
    const T up = select(rise > fall, share, one), down = select(fall > rise, share, one);
    T Pi_slope(0);
    for (int k = 0; k < K; ++k) {
      T& alpha = slope[FaceRow::alpha(k)];
      const T keep = select(alpha > none, up, select(alpha < none, down, one));
      alpha = keep * alpha;
      slope[FaceRow::arho(k)] = keep * slope[FaceRow::arho(k)];
      Pi_slope += curved[size_t(k)] ? keep * part(k) : T(Pi[size_t(k)]) * alpha;
    }
    slope[Prim::Pi] = Pi_slope;
  }
  template <class T>
  static void predict(T (&W)[n], const T (&slope)[3][n], const T (&k)[3], T rho_c2, T dPi) {
    half_step_many<K>(W, slope, k, rho_c2, dPi);
  }
  template <int axis, class T>
  T flux(const T (&L)[n], const T (&R)[n], const Sound<T>& sound_L, const Sound<T>& sound_R, T (&F)[n_flux]) const {
    return hllc<axis>(L, R, sound_L, sound_R, closure, 1e30, F);
  }
};

/// One material with a constant Pi, in the rows of its density.
struct GasFlow {
  static constexpr int n = GasPrim::count, n_flux = GasCons::count, v = GasPrim::v, p = GasPrim::p;
  static constexpr bool mixed = false;
  static constexpr int materials = 1;
  double over_G, Pi;
  int rho_row;             ///< of Prim
  int rho_cons = rho_row;  ///< of Cons

  int prim_row(int q) const { return q == 0 ? rho_row : Prim::v + q - 1; }
  int cons_row(int q) const { return q == 0 ? rho_cons : Cons::mom + q - 1; }
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
