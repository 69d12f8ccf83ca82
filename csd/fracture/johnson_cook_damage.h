// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "csd/fracture/sample.h"
#include "csd/material/failure_data.h"

namespace bw::csd {

/// Damage D = sum of d(eqps) / eps_f (csd/material/failure_data.h), failure at D = 1. The stress is looked at when eqps
/// has grown by a part of the way, not in every step: D is a sum over strain.
struct JohnsonCookDamage {
  double least_strain = 1e-3, strain_step = 2e-3;
  bool in_compression = false;
  double T_room = 293;
  DamageConstants constants{.D1 = std::numeric_limits<double>::infinity()};  // of the element's material
  double T_melt = 0;                                                         // K, of the element's material; 0: unknown
  static constexpr auto name = "johnson_cook";
  static constexpr int memory = 3;  // D; eqps when last looked at; s of flow since then
  static constexpr bool reads_pressure = false;
  template <class K>
  void describe(K& k) {
    k.optional("least_strain", least_strain, dim::none, "floor of the strain at failure");
    k.optional("strain_step", strain_step, dim::none,
               "growth of eqps after which stress, rate and temperature are looked at again; 0: in every step");
    k.optional("reference_temperature", T_room, dim::temperature, "where T* of the material's `damage` is 0");
    k.optional("in_compression", in_compression, "damage below a stress triaxiality of -1/3 too");
    k.expect(least_strain > 0, "least_strain", "a positive strain");
    k.expect(T_room >= 0, "reference_temperature", "a temperature >= 0 K");
    k.expect(strain_step >= 0, "strain_step", "a strain >= 0");
  }
  bool is_known(const FailureData& material) const { return material.damage.has_value(); }
  void take(const FailureData& material) {
    if (material.damage) constants = *material.damage;
    T_melt = material.melting_temperature;
  }
  double strain_at_failure(double triaxiality, double rate, double temperature) const {
    constexpr double most = 1.5;  // beyond, the law was not measured
    const auto& [D1, D2, D3, D4, D5, rate_0] = constants;
    const double by_rate = 1 + D4 * std::log(std::max(rate / rate_0, 1.0));
    const double star = T_melt > T_room ? std::clamp((temperature - T_room) / (T_melt - T_room), 0.0, 1.0) : 0;
    return std::max((D1 + D2 * std::exp(D3 * std::min(triaxiality, most))) * by_rate * (1 + D5 * star), least_strain);
  }
  bool wants_stress(const Sample& s, const double* m) const { return s.eqps > m[1] && s.eqps - m[1] >= strain_step; }
  double fail(const Sample& s, double* m) const {
    if (s.eqps > m[1]) m[2] += s.dt;
    if (!s.has_stress) return m[0];
    const Sym3 dev = deviator(s.sigma);
    const double mises = std::sqrt(1.5 * contract(dev, dev)), grown = s.eqps - m[1];
    const double triaxiality = mises > 0 ? trace(s.sigma) / (3 * mises) : 0;
    if (in_compression || triaxiality > -1.0 / 3)
      m[0] += grown / strain_at_failure(triaxiality, m[2] > 0 ? grown / m[2] : 0, s.temperature);
    m[1] = s.eqps, m[2] = 0;
    return m[0];
  }
};

}  // namespace bw::csd
