// SPDX-License-Identifier: Apache-2.0
// Three and more materials with one velocity and one pressure: the five-equation model with the sums of
// cfd/mix/five_equation.h over all of them. The form of each equation of state is looked up at run time.
#pragma once
#include <array>

#include "cfd/mix/five_equation.h"

namespace bw::cfd {

template <int K>
struct ManyMaterials {
  static_assert(K > 2 && K <= most_materials);
  static constexpr int materials = K, n_cons = Cons::rows(K), n_prim = Prim::rows(K);
  std::array<EosForm, K> form;
  std::array<double, K> over_G, b_G;  ///< 1/Gruneisen, b/Gruneisen [m^3/kg]
  double least_G = 0;

  explicit ManyMaterials(const std::array<EosForm, K>& forms) : form(forms) {
    for (size_t k = 0; k < K; ++k)
      std::visit([&](const auto& m) { over_G[k] = 1 / m.Gruneisen(), b_G[k] = m.covolume() / m.Gruneisen(); }, form[k]);
    least_G = least_free * *std::min_element(over_G.begin(), over_G.end());
  }

  /// What material k adds to Pi, the stiffness and arho dPi/d(arho).
  template <class T>
  PiTerms<T> part(int k, T arho, T alpha) const {
    PiTerms<T> sum{T(0), T(0), T(0)};
    std::visit([&](const auto& m) { add_material(m, arho, alpha, sum); }, form[size_t(k)]);
    return sum;
  }
  /// sum alpha_k (1 - b_k rho_k)/Gruneisen_k of a cell.
  template <class T>
  T G(const T* W) const {
    T sum(0);
    for (int k = 0; k < K; ++k)
      sum += W[Prim::alpha(k)] * T(over_G[size_t(k)]) - W[Prim::arho(k)] * T(b_G[size_t(k)]);
    return sum;
  }

  /// As FiveEquation.
  template <class T>
  T to_primitive(const T* U, T* W, const Floors& floors) const {
    T rho(0), G_alpha(0), taken(0);
    PiTerms<T> sum{T(0), T(0), T(0)};
    for (int k = 0; k < K; ++k) {
      const T arho = U[Cons::arho(k)], alpha = U[Cons::alpha(k)];
      const PiTerms<T> own = part(k, arho, alpha);
      rho += arho;
      G_alpha += alpha * T(over_G[size_t(k)]);
      taken += arho * T(b_G[size_t(k)]);
      sum.pi += own.pi, sum.stiffness += own.stiffness, sum.dpi += own.dpi;
      W[Prim::arho(k)] = arho;
      W[Prim::alpha(k)] = alpha;
      W[Prim::part(k)] = own.pi;
    }
    const T over_rho = T(1) / max(rho, T(floors.rho));
    T twice_kinetic(0);
    for (int d = 0; d < 3; ++d) {
      W[Prim::v + d] = U[Cons::mom + d] * over_rho;
      twice_kinetic += U[Cons::mom + d] * W[Prim::v + d];
    }
    const T over_G_sum = T(1) / max(G_alpha - taken, T(least_G));
    const T p_raw = (U[Cons::rhoE] - T(0.5) * twice_kinetic - sum.pi) * over_G_sum, p = max(p_raw, T(floors.p));
    const T rho_c2 = max((sum.stiffness + p * (T(1) + G_alpha)) * over_G_sum, T(floors.p));
    W[Prim::p] = p;
    W[Prim::Pi] = sum.pi;
    W[Prim::c] = sqrt(rho_c2 * over_rho);
    W[Prim::rho_c2] = rho_c2;
    W[Prim::dPi] = sum.dpi;
    return p_raw;
  }

  template <class T>
  void to_conserved(const T* W, T* U) const {
    T rho(0), pi(0), twice_kinetic(0);
    for (int k = 0; k < K; ++k) {
      U[Cons::arho(k)] = W[Prim::arho(k)];
      U[Cons::alpha(k)] = W[Prim::alpha(k)];
      rho += W[Prim::arho(k)];
      pi += part(k, W[Prim::arho(k)], W[Prim::alpha(k)]).pi;
    }
    for (int d = 0; d < 3; ++d) {
      U[Cons::mom + d] = rho * W[Prim::v + d];
      twice_kinetic += W[Prim::v + d] * W[Prim::v + d];
    }
    U[Cons::rhoE] = G(W) * W[Prim::p] + pi + T(0.5) * rho * twice_kinetic;
  }
};

}  // namespace bw::cfd
