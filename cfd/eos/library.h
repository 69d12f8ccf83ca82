// SPDX-License-Identifier: Apache-2.0
// Materials by name. Explosives: Dobratz & Crawford, LLNL Explosives Handbook, UCRL-52997 (1985): rho0 [g/cm^3], A, B [GPa], R1, R2, omega,
// E0 [GPa], D [km/s] and P_CJ [GPa] as tabulated; the CJ state that follows from each set is compared at start-up
// (cfd/source/detonation.h). Air at 15 degC; water as a stiffened gas [Saurel & Abgrall 1999].
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cfd/eos/list.h"

namespace bw::cfd {

struct LibraryExplosive {
  const char* name;
  double rho0, A, B, R1, R2, omega, E0, D, p_CJ;
  bool consistent = true;  ///< false: D and P_CJ as tabulated do not follow from the set
  Jwl jwl() const {
    Jwl m;
    m.rho0 = 1e3 * rho0, m.A = 1e9 * A, m.B = 1e9 * B, m.R1 = R1, m.R2 = R2, m.omega = omega, m.E0 = 1e9 * E0;
    m.D = 1e3 * D, m.p_CJ = 1e9 * p_CJ;
    return m;
  }
};

inline constexpr std::array explosives{
    LibraryExplosive{"TNT", 1.630, 371.2, 3.231, 4.15, 0.95, 0.30, 7.0, 6.93, 21.0},
    LibraryExplosive{"Comp B", 1.717, 524.2, 7.678, 4.20, 1.10, 0.34, 8.5, 7.98, 29.5},
    LibraryExplosive{"C-4", 1.601, 609.77, 12.95, 4.50, 1.40, 0.25, 9.0, 8.193, 28.0},
    LibraryExplosive{"PETN", 1.770, 617.0, 16.926, 4.40, 1.20, 0.25, 10.1, 8.30, 33.5},
    LibraryExplosive{"PETN 1.50", 1.500, 625.3, 23.29, 5.25, 1.60, 0.28, 8.56, 7.45, 22.0},
    LibraryExplosive{"LX-14", 1.835, 826.1, 17.24, 4.55, 1.32, 0.38, 10.2, 8.80, 37.0},
    LibraryExplosive{"Octol 78/22", 1.821, 748.6, 13.38, 4.50, 1.20, 0.38, 9.6, 8.48, 34.2},
    LibraryExplosive{"HMX", 1.891, 778.3, 7.071, 4.20, 1.00, 0.30, 10.5, 9.11, 42.0, false},
    LibraryExplosive{"PBX-9404", 1.840, 852.4, 18.02, 4.60, 1.30, 0.38, 10.2, 8.80, 37.0},
    LibraryExplosive{"LX-10", 1.865, 880.7, 18.36, 4.62, 1.32, 0.38, 10.4, 8.82, 37.5},
    LibraryExplosive{"Cyclotol 77/23", 1.754, 603.4, 9.924, 4.30, 1.10, 0.35, 9.2, 8.25, 32.0},
    LibraryExplosive{"H-6", 1.760, 758.07, 8.513, 4.90, 1.10, 0.20, 10.3, 7.47, 24.0},
    LibraryExplosive{"Pentolite", 1.700, 540.94, 9.3726, 4.50, 1.10, 0.35, 8.1, 7.53, 25.5},
};

/// Heat of combustion to CO2, N2 and water vapour at 25 degC [J/kg], from heats of formation in kJ/mol: CO2 -393.51,
/// H2O -241.83 [CODATA]; TNT C7H5N3O6 -63.2, PETN C5H8N4O12 -538.5 [NIST WebBook]. Explosives of one substance only.
inline std::optional<double> heat_of_combustion(const std::string& name) {
  constexpr double CO2 = 393.51, H2O = 241.83;
  if (name == "TNT") return 1e6 * (7 * CO2 + 2.5 * H2O - 63.2) / 227.13;
  if (name == "PETN" || name == "PETN 1.50") return 1e6 * (5 * CO2 + 4 * H2O - 538.5) / 316.14;
  return {};
}

inline std::vector<std::string> library_names() {
  std::vector<std::string> names{"air", "water"};
  for (const LibraryExplosive& e : explosives) names.push_back(e.name);
  return names;
}

inline std::optional<EosChoice> from_library(const std::string& name) {
  if (name == "air") return IdealGas{1.4};
  if (name == "water") return StiffenedGas{4.4, 6e8};
  for (const LibraryExplosive& e : explosives)
    if (name == e.name) return e.jwl();
  return {};
}

}  // namespace bw::cfd
