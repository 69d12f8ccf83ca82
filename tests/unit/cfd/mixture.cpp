// SPDX-License-Identifier: Apache-2.0
// The mixture's closure, the CJ state of TNT, programmed burn.
#include <gtest/gtest.h>

#include <cmath>

#include "cfd/eos/library.h"
#include "cfd/mix/list.h"
#include "cfd/source/burn.h"
#include "cfd/source/detonation.h"

namespace bw::cfd {
namespace {

std::vector<EosChoice> samples() {
  std::vector<EosChoice> list{IdealGas{1.4}, IdealGas{5.0 / 3}, StiffenedGas{4.4, 6e8}, NobleAbel{1.27, 1e-3}};
  for (const LibraryExplosive& e : explosives) list.push_back(e.jwl());
  return list;
}

/// check(model, rho, p) over the range of every model.
template <class Check>
void for_each_state(const Check& check) {
  for (const EosChoice& choice : samples())
    std::visit(
        [&](const auto& m) {
          const EosRange r = m.range();
          for (int i = 0; i <= 8; ++i)
            for (int j = 0; j <= 8; ++j)
              check(m, r.rho_min * std::pow(r.rho_max / r.rho_min, i / 8.0),
                    r.p_min * std::pow(r.p_max / r.p_min, j / 8.0));
        },
        choice);
}

TEST(Eos, PiTermsAreDerivatives) {
  for_each_state([](const auto& m, double rho, double) {
    const double d = 1e-4;
    const auto pi = [&](double x) { return pi_terms(m, rho * (1 + x)).pi; };
    const double slope = (8 * (pi(d) - pi(-d)) - (pi(2 * d) - pi(-2 * d))) / (12 * d * rho);
    const PiTerms<double> t = pi_terms(m, rho);
    EXPECT_NEAR(t.dpi, slope, 1e-6 * std::abs(t.dpi) + 1e-9 * std::abs(t.pi / rho) + 1e-100)
        << m.name << " rho " << rho;
  });
}

TEST(Mixture, OneMaterialIsItsOwnEquationOfState) {
  const Jwl tnt = explosives[0].jwl();
  const FiveEquation<Jwl, IdealGas> pair{tnt, IdealGas{1.4}};
  double W[Prim::stored] = {900, 0, 0, 0, 0, 3e9, 1}, U[Cons::count];
  pair.to_conserved(W, U);
  EXPECT_NEAR(U[Cons::rhoE], 900 * internal_energy(tnt, 900.0, 3e9), 1e-13 * U[Cons::rhoE]);
  pair.to_primitive(U, W, Floors{});
  EXPECT_NEAR(W[Prim::c], sound_speed(tnt, 900.0, 3e9), 1e-12 * W[Prim::c]);
  double air[Prim::stored] = {0, 1.2, 0, 0, 0, 1e5, 0};
  pair.to_conserved(air, U);
  pair.to_primitive(U, air, Floors{});
  EXPECT_EQ(air[Prim::Pi], 0);
  EXPECT_NEAR(air[Prim::c], std::sqrt(1.4 * 1e5 / 1.2), 1e-12 * 340);
}

TEST(Library, CjOfTntToAllDigits) {
  const CjState s = cj_state(explosives[0].jwl());  // VALIDATION F6
  EXPECT_NEAR(s.V, 0.731688, 2e-6);
  EXPECT_NEAR(s.u, 1859.23, 0.02);
  EXPECT_NEAR(s.c, 5070.12, 0.02);
}

TEST(Detonation, PhasesOfABlock) {
  Burn b;
  b.points = {{0, 0, 0}};
  b.D = 7000, b.h = b.margin = 0.01, b.width = 3, b.q = 1;
  const Vec3 lower{0.1, 0, 0}, upper{0.2, 0.1, 0.1};
  const double arrives = (0.1 - b.h) / b.D, leaves = (norm({0.21, 0.11, 0.11}) + b.width * b.h) / b.D;
  EXPECT_EQ(b.phase(lower, upper, 0, 0.99 * arrives), Burn::Phase::before);
  EXPECT_EQ(b.phase(lower, upper, 0, 1.01 * arrives), Burn::Phase::during);
  EXPECT_EQ(b.phase(lower, upper, 0.999 * leaves, 2 * leaves), Burn::Phase::during);
  EXPECT_EQ(b.phase(lower, upper, 1.001 * leaves, 2 * leaves), Burn::Phase::after);
  EXPECT_EQ(b.stored({0.14, 0, 0}, 0.14 / b.D), 1);
  EXPECT_NEAR(b.stored({0.14, 0, 0}, (0.14 + 1.5 * b.h) / b.D), 0.5, 1e-12);
}

}  // namespace
}  // namespace bw::cfd
