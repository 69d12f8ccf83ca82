// SPDX-License-Identifier: Apache-2.0
// What every solid has: density, two elastic constants with kappa and mu after them (VALIDATION A.1), a volumetric law.
#pragma once
#include <cmath>

#include "common/math/units.h"
#include "csd/material/volumetric.h"

namespace bw::csd {

struct Elastic {
  double density = 0;  ///< kg/m^3, reference
  double E_young = 0;  ///< Pa
  double nu = 0;       ///< Poisson's ratio
  double mu = 0;       ///< Pa, shear modulus
  Volumetric volumetric;

  Elastic() = default;
  Elastic(double density, double E_young, double nu, const VolumetricLaws& law = {})
      : density(density), E_young(E_young), nu(nu) {
    volumetric.law = law;
    derive();
  }
  void derive() {
    const auto* hugoniot = std::get_if<MieGruneisen>(&volumetric.law);
    volumetric.kappa = hugoniot ? density * hugoniot->c0 * hugoniot->c0 : E_young / (3 * (1 - 2 * nu));
    mu = E_young / (2 * (1 + nu));
  }
  /// m/s: waves in uniaxial strain, at rest.
  double sound_speed() const { return std::sqrt((volumetric.kappa + 4 * mu / 3) / density); }

  template <class K>
  void describe(K& k) {
    k.required("density", density, dim::density, "mass per reference volume");
    k.required("young_modulus", E_young, dim::pressure, "Young's modulus E");
    k.required("poisson_ratio", nu, dim::none, "Poisson's ratio nu, in (-1, 0.5)");
    k.expect(density > 0, "density", "a positive density");
    k.expect(E_young > 0, "young_modulus", "a positive stress");
    k.expect(nu > -1 && nu < 0.5, "poisson_ratio",
             "a number in (-1, 0.5); for nearly incompressible use 0.4999: at 0.5 the bulk modulus is infinite and no "
             "explicit step is stable");
    struct Law {
      VolumetricLaws& law;
      void describe(K& k) { k.pick("kind", law, "how the mean stress depends on the volume"); }
    } table{volumetric.law};
    k.table("volumetric", table, "volumetric law; the paper's unless given");
    derive();
  }
};

}  // namespace bw::csd
