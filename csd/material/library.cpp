// SPDX-License-Identifier: Apache-2.0
// Sources.
//   [JC83]  G. R. Johnson, W. H. Cook, 7th Int. Symp. Ballistics, The Hague 1983, 541: density, specific heat, melting
//           temperature, flow stress
//   [JC85]  G. R. Johnson, W. H. Cook, Eng. Fract. Mech. 21 (1985) 31: constants of damage
//   [ZA87]  F. J. Zerilli, R. W. Armstrong, J. Appl. Phys. 61 (1987) 1816: flow stress (grains of 73 um in copper)
//   [B09]   N. S. Brar, V. S. Joshi, B. W. Harris, AIP Conf. Proc. 1195 (2009) 945: flow stress, constants of damage
//   [S96]   D. J. Steinberg, Equation of State and Strength Properties of Selected Materials, UCRL-MA-106439 Change 1,
//           1996: c0 and s. Of the alloy or its nearest relative: 2024-T4, 7075-T6, and 4340 for all irons and steels,
//           below their transition at 13 GPa
//   [M80]   S. P. Marsh (ed.), LASL Shock Hugoniot Data, 1980: c0 and s of brass
//   elastic constants: handbook values; OFHC copper as usual with [JC83]. 7075: density of [S96], specific heat and
//   the end of melting from handbooks
// Flow stresses of OFHC copper, Armco iron (but m) and tungsten alloy and constants of damage of OFHC copper and 4340
// agree with the transcriptions in Uintah's inputs (MPM/MaterialData). [ZA87] and the damage of Armco iron have not
// been compared with a second source. [JC83] took 0.55 for Armco iron's m; 1.44, which codes carry too, is nickel's.
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
FailureData damage(double D1, double D2, double D3, double D4, double D5, double melting = 0) {
  return {0, melting, DamageConstants{D1, D2, D3, D4, D5}};
}
J2Case linear(const Elastic& elastic, double yield, double hardening) {
  return {elastic, {}, LinearFlow{yield, hardening}, {}};
}

std::vector<LibraryEntry> make_library() {
  const MieGruneisen copper{3940, 1.489}, steel{4578, 1.330}, aluminium_2024{5328, 1.338}, aluminium_7075{5200, 1.360},
      tungsten{4030, 1.237}, nickel{4650, 1.445}, brass{3726, 1.434};
  const Elastic ofhc(8960, 124 * GPa, 0.34), armco(7890, 207 * GPa, 0.29);
  return {
      {"copper OFHC", "[JC83], [S96], [JC85]", johnson_cook(ofhc, 383, 1356, 90, 292, 0.31, 0.025, 1.09), copper,
       damage(0.54, 4.89, -3.03, 0.014, 1.12)},
      {"copper OFHC/ZA", "[ZA87], [S96], [JC85]",
       zerilli_armstrong(ofhc, 383, {.C0 = 65 * MPa, .C2 = 890 * MPa, .C3 = 0.0028, .C4 = 0.000115}), copper,
       damage(0.54, 4.89, -3.03, 0.014, 1.12, 1356)},
      {"brass cartridge", "[JC83], [M80]",
       johnson_cook({8520, 115 * GPa, 0.31}, 385, 1189, 112, 505, 0.42, 0.009, 1.68), brass},
      {"nickel 200", "[JC83], [S96]", johnson_cook({8900, 207 * GPa, 0.31}, 446, 1726, 163, 648, 0.33, 0.006, 1.44),
       nickel},
      {"iron Armco", "[JC83], [S96], [JC85]", johnson_cook(armco, 452, 1811, 175, 380, 0.32, 0.060, 0.55), steel,
       damage(-2.20, 5.43, -0.47, 0.016, 0.63)},
      {"iron Armco/ZA", "[ZA87], [S96], [JC85]",
       zerilli_armstrong(armco, 452, {.C1 = 1033 * MPa, .C3 = 0.00698, .C4 = 0.000415, .C5 = 266 * MPa, .n = 0.289}),
       steel, damage(-2.20, 5.43, -0.47, 0.016, 0.63, 1811)},
      {"iron Carpenter", "[JC83], [S96]", johnson_cook(armco, 452, 1811, 290, 339, 0.40, 0.055, 0.55), steel},
      {"steel 1006", "[JC83], [S96]", johnson_cook(armco, 452, 1811, 350, 275, 0.36, 0.022, 1.00), steel},
      {"steel 4340", "[JC83], [S96], [JC85]",
       johnson_cook({7830, 206 * GPa, 0.29}, 477, 1793, 792, 510, 0.26, 0.014, 1.03), steel,
       damage(0.05, 3.44, -2.12, 0.002, 0.61)},
      {"steel S-7", "[JC83], [S96]", johnson_cook({7750, 207 * GPa, 0.29}, 477, 1763, 1539, 477, 0.18, 0.012, 1.00),
       steel},
      {"aluminium 2024-T351", "[JC83], [S96]",
       johnson_cook({2770, 73.1 * GPa, 0.33}, 875, 775, 265, 426, 0.34, 0.015, 1.00), aluminium_2024},
      {"aluminium 7039", "[JC83], [S96]", johnson_cook({2770, 70 * GPa, 0.33}, 875, 877, 337, 343, 0.41, 0.010, 1.00),
       aluminium_7075},
      {"aluminium 7075-T651", "[B09], [S96]",
       johnson_cook({2804, 71.7 * GPa, 0.33}, 960, 908, 527, 676, 0.71, 0.017, 1.61), aluminium_7075,
       damage(0.110, 0.573, -3.4446, 0.016, 1.099)},
      {"tungsten alloy", "[JC83], [S96]",
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
