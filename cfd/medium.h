// SPDX-License-Identifier: Apache-2.0
// The materials of a run: names, equations of state, and the shortcuts for cells of one material with a constant Pi.
#pragma once
#include <string>
#include <vector>

#include "cfd/mix/list.h"
#include "cfd/scheme/flow_model.h"

namespace bw::cfd {

/// Volume fractions that files tell, of the first materials: of two the first, of more all.
inline int told_fractions(size_t materials) { return materials == 1 ? 0 : materials == 2 ? 1 : int(materials); }

struct Medium {
  Medium() = default;
  /// One material alone is its own twin, with alpha1 exactly 1 everywhere.
  Medium(std::vector<std::string> names_, const std::vector<EosChoice>& eos_, const Floors& floors_)
      : names(std::move(names_)), mixture(make_mixture(eos_)), floors(floors_) {
    for (int m = 0; m < std::max(count(), 2); ++m) {
      eos[m] = m < count() ? eos_[size_t(m)] : eos_.back();
      std::visit(
          [&](const auto& e) {
            gas[m] = {1 / e.Gruneisen(), -e.reference(1.0).p / e.Gruneisen(), Prim::arho(m), Cons::arho(m)};
            is_gas[m] = e.constant_reference && e.covolume() == 0;
          },
          eos[m]);
    }
  }
  int count() const { return int(names.size()); }
  int told_fractions() const { return cfd::told_fractions(names.size()); }
  /// Variables of a cell.
  int rows() const { return Cons::rows(count()); }
  /// kg/m^3 of all materials.
  double density(const double* U) const {
    double rho = U[Cons::arho1] + U[Cons::arho2];
    for (int k = 2; k < count(); ++k) rho += U[Cons::arho(k)];
    return rho;
  }
  /// Volume fraction of material k (from 0) in a cell U.
  double alpha(const double* U, int k) const {
    return k == 1 && count() <= 2 ? 1 - U[Cons::alpha1] : U[Cons::alpha(k)];
  }
  /// 1, 2 ...: the cell holds this material alone; 0: mixed.
  int material_of(const double* U) const {
    if (count() <= 2) return U[Cons::alpha1] == 1.0 ? 1 : U[Cons::alpha1] == 0.0 ? 2 : 0;
    for (int k = 0; k < count(); ++k)
      if (U[Cons::alpha(k)] == 1.0) return k + 1;
    return 0;
  }

  std::vector<std::string> names;
  EosChoice eos[most_materials];
  Mixture mixture;
  Floors floors;
  bool is_gas[most_materials] = {};  ///< its Pi is constant, gas[] holds alone
  GasFlow gas[most_materials]{};
  Interface interface {};  ///< how cells of two materials are reconstructed
};

/// The flow of two materials (or of one that is its own twin).
inline MixedFlow mixed_flow(const Medium& medium) {
  MixedFlow flow{};
  std::visit(
      [&]<class Mix>(const Mix& mix) {
        if constexpr (Mix::materials == 2) flow = {mix.closure(), medium.interface};
      },
      medium.mixture);
  return flow;
}

/// GasPrim of one gas. Returns p before the lift.
template <class T>
[[gnu::always_inline]] inline T gas_to_primitive(const GasFlow& flow, const T (&U)[GasCons::count],
                                                 T (&W)[GasPrim::stored], const Floors& floors) {
  const T rho = max(U[GasCons::rho], T(floors.rho)), over_rho = T(1) / rho;
  const T vx = U[GasCons::mom] * over_rho, vy = U[GasCons::mom_y] * over_rho, vz = U[GasCons::mom_z] * over_rho;
  const T kinetic = T(0.5) * (U[GasCons::mom] * vx + U[GasCons::mom_y] * vy + U[GasCons::mom_z] * vz);
  const T over_G = T(1) / T(flow.over_G);
  const T p_raw = (U[GasCons::rhoE] - kinetic - T(flow.Pi)) * over_G, p = max(p_raw, T(floors.p));
  const T rho_c2 = p * (T(1) + over_G) + T(flow.Pi) * over_G;
  W[GasPrim::c] = sqrt(rho_c2 * over_rho);
  W[GasPrim::rho_c2] = rho_c2;
  W[GasPrim::rho] = U[GasCons::rho];
  W[GasPrim::v] = vx;
  W[GasPrim::v_y] = vy;
  W[GasPrim::v_z] = vz;
  W[GasPrim::p] = p;
  return p_raw;
}

}  // namespace bw::cfd
