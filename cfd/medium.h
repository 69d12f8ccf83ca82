// SPDX-License-Identifier: Apache-2.0
// The materials of a run: names, equations of state, and the shortcuts for cells of one material with a constant Pi.
#pragma once
#include <string>
#include <vector>

#include "cfd/mix/list.h"
#include "cfd/scheme/flow_model.h"

namespace bw::cfd {

struct Medium {
  Medium() = default;
  /// One or two materials; one alone is its own twin, with alpha1 exactly 1 everywhere.
  Medium(std::vector<std::string> names_, const std::vector<EosChoice>& eos_, const Floors& floors_)
      : names(std::move(names_)), mixture(make_mixture(eos_.front(), eos_.back())), floors(floors_) {
    closure = cfd::closure(mixture);
    for (int m = 0; m < 2; ++m)
      std::visit(
          [&](const auto& e) {
            gas[m] = {1 / e.Gruneisen(), -e.reference(1.0).p / e.Gruneisen(), m == 0 ? Prim::arho1 : Prim::arho2};
            is_gas[m] = e.constant_reference && e.covolume() == 0;
          },
          m == 0 ? eos_.front() : eos_.back());
    eos[0] = eos_.front(), eos[1] = eos_.back();
  }
  int count() const { return int(names.size()); }

  std::vector<std::string> names;
  EosChoice eos[2];
  Mixture mixture;
  Closure closure{};
  Floors floors;
  bool is_gas[2] = {false, false};  ///< material 1, 2: its Pi is constant, gas[] holds alone
  GasFlow gas[2]{};
  Interface interface {};  ///< how cells of both materials are reconstructed
  MixedFlow mixed() const { return {closure, interface}; }
};

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
