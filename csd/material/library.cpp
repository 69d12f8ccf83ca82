// SPDX-License-Identifier: Apache-2.0
// Sources.
//   [JC83]  G. R. Johnson, W. H. Cook, 7th Int. Symp. Ballistics, The Hague 1983, 541: density, specific heat, melting
//           temperature, flow stress
//   [ZA87]  F. J. Zerilli, R. W. Armstrong, J. Appl. Phys. 61 (1987) 1816: flow stress
//   [M80]   S. P. Marsh (ed.), LASL Shock Hugoniot Data, 1980: c0, s (of pure copper, iron, the nearest alloys)
//   elastic constants: handbook values; OFHC copper as usual with [JC83]
#include "csd/material/material_case.h"

namespace bw::csd {
namespace {

constexpr double GPa = 1e9, MPa = 1e6;

J2Case johnson_cook(const Elastic& elastic, double specific_heat, double melting, double A, double B, double n,
                    double C, double m) {
  return {elastic,
          Heat{specific_heat, 0.9, 293},
          JohnsonCook{.A = A * MPa, .B = B * MPa, .n = n, .C = C, .m = m, .T_melt = melting},
          {}};
}
J2Case zerilli_armstrong(const Elastic& elastic, double specific_heat, const ZerilliArmstrong& law) {
  return {elastic, Heat{specific_heat, 0.9, 293}, law, {}};
}
J2Case linear(const Elastic& elastic, double yield, double hardening) {
  return {elastic, {}, LinearFlow{yield, hardening}, {}};
}

std::vector<LibraryEntry> make_library() {
  const MieGruneisen copper{3940, 1.489}, iron{3574, 1.920}, aluminium{5328, 1.338}, tungsten{4029, 1.237},
      brass{3726, 1.434};
  const Elastic ofhc(8960, 124 * GPa, 0.34), armco(7890, 207 * GPa, 0.29);
  return {
      {"copper OFHC", "[JC83], [M80]", johnson_cook(ofhc, 383, 1356, 90, 292, 0.31, 0.025, 1.09), copper},
      {"copper OFHC/ZA", "[ZA87], [M80]",
       zerilli_armstrong(ofhc, 383, {.C0 = 65 * MPa, .C2 = 890 * MPa, .C3 = 0.0028, .C4 = 0.000115}), copper},
      {"brass cartridge", "[JC83], [M80]",
       johnson_cook({8520, 115 * GPa, 0.31}, 385, 1189, 112, 505, 0.42, 0.009, 1.68), brass},
      {"iron Armco", "[JC83], [M80]", johnson_cook(armco, 452, 1811, 175, 380, 0.32, 0.060, 0.55), iron},
      {"iron Armco/ZA", "[ZA87], [M80]",
       zerilli_armstrong(armco, 452, {.C1 = 1033 * MPa, .C3 = 0.00698, .C4 = 0.000415, .C5 = 266 * MPa, .n = 0.289}),
       iron},
      {"steel 1006", "[JC83], [M80]", johnson_cook(armco, 452, 1811, 350, 275, 0.36, 0.022, 1.00), iron},
      {"steel 4340", "[JC83], [M80]", johnson_cook({7830, 206 * GPa, 0.29}, 477, 1793, 792, 510, 0.26, 0.014, 1.03),
       iron},
      {"steel S-7", "[JC83], [M80]", johnson_cook({7750, 207 * GPa, 0.29}, 477, 1763, 1539, 477, 0.18, 0.012, 1.00),
       iron},
      {"aluminium 2024-T351", "[JC83], [M80]",
       johnson_cook({2770, 73.1 * GPa, 0.33}, 875, 775, 265, 426, 0.34, 0.015, 1.00), aluminium},
      {"aluminium 7039", "[JC83], [M80]", johnson_cook({2770, 70 * GPa, 0.33}, 875, 877, 337, 343, 0.41, 0.010, 1.00),
       aluminium},
      {"tungsten alloy", "[JC83], [M80]",
       johnson_cook({17000, 345 * GPa, 0.29}, 134, 1723, 1506, 177, 0.12, 0.016, 1.00), tungsten},
      {"paper", "the paper's weapon steel; its Young's modulus is 500 times its yield stress",
       linear({7760, 641.5 * GPa, 0.3}, 1.283 * GPa, 8.657 * GPa)},
      {"paper/3.114", "the paper's with its stresses over 3.114: a plausible steel",
       linear({7760, 206 * GPa, 0.3}, 0.412 * GPa, 2.78 * GPa)},
  };
}

}  // namespace

const std::vector<LibraryEntry>& material_library() {
  static const std::vector<LibraryEntry> library = make_library();
  return library;
}

}  // namespace bw::csd
