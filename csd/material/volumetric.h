// SPDX-License-Identifier: Apache-2.0
// Volumetric part of the stored energy, a function of J. Mean stress sigma_m is tension positive everywhere in csd.
#pragma once
#include <variant>

#include "csd/material/mie_gruneisen.h"
#include "csd/material/murnaghan.h"
#include "csd/material/paper_volume.h"

namespace bw::csd {

/// A law has, per bulk modulus and for J > 0: energy, its derivative mean_stress, and stiffness = J d(mean_stress)/dJ >
/// 0.
using VolumetricLaws = std::variant<PaperVolume, MieGruneisen, Murnaghan>;

/// Once an element, so the law is a branch and not a template argument of the kernels: it is used with any flow.
struct Volumetric {
  double kappa = 0;  ///< Pa, bulk modulus at rest
  VolumetricLaws law;

  /// J/m^3 of reference volume.
  template <class T>
  T energy(T J) const {
    return T(kappa) * std::visit([&](const auto& l) { return l.energy(J); }, law);
  }
  /// sigma_m = U'(J) [Pa].
  template <class T>
  T mean_stress(T J) const {
    if (law.index() == 0) [[likely]]
      return T(kappa) * PaperVolume().mean_stress(J);
    return other_mean_stress(J);
  }
  /// J U''(J) [Pa]: stiffness of the current volume against dilatation.
  template <class T>
  T stiffness(T J) const {
    if (law.index() == 0) [[likely]]
      return T(kappa) * PaperVolume().stiffness(J);
    return other_stiffness(J);
  }

 private:
  template <class T>
  [[gnu::noinline]] T other_mean_stress(T J) const {
    return T(kappa) * std::visit([&](const auto& l) { return l.mean_stress(J); }, law);
  }
  template <class T>
  [[gnu::noinline]] T other_stiffness(T J) const {
    return T(kappa) * std::visit([&](const auto& l) { return l.stiffness(J); }, law);
  }
};

}  // namespace bw::csd
