// SPDX-License-Identifier: Apache-2.0
// The half-Riemann wall against exact values (F10) and integrated isentropes (F10c).
#include <gtest/gtest.h>

#include "cfd/embed/wall_gas.h"
#include "embed_block.h"

namespace bw::cfd {
namespace {

using namespace test;

struct Row {
  double u, p, rho;
};
WallStar air(double dv) {
  return wall_star(1.225, 101325, 1.4 * 101325, 2.5, dv, true, [](double, double p) { return 1.4 * p; });
}

TEST(EmbedWallState, CompressionAndExpansionOfAir) {
  for (const Row& r : {Row{50, 124086.35, 1.415446}, Row{100, 151004.02, 1.625925}, Row{340, 351540.23, 2.822273},
                       Row{1000, 1681308.65, 5.452307}, Row{2000, 6097251.9, 6.702099}, Row{-50, 82232.10, 1.055281},
                       Row{-100, 66309.87, 0.904917}, Row{-340, 21281.54, 0.401842}, Row{-1000, 205.121, 0.014590}}) {
    const WallStar s = air(r.u);
    EXPECT_NEAR(s.p / r.p, 1, 5e-6) << r.u;
    EXPECT_NEAR(1.225 * s.compress / r.rho, 1, 5e-5) << r.u;
  }
  const WallStar vacuum = air(-2000);
  EXPECT_GE(vacuum.p, 0);
  EXPECT_LT(vacuum.p, 1e-2);
  EXPECT_GT(vacuum.compress, 0);
}

TEST(EmbedWallState, IntegratedFanMatchesClosedForm) {
  for (const double dv : {-1.0, -30.0, -300.0, -1200.0, -1600.0}) {
    const WallStar exact = air(dv);
    const WallStar found = detail::fan(1.225, 101325, 2.5, dv, [](double, double p) { return 1.4 * p; });
    EXPECT_NEAR(found.p / exact.p, 1, 1e-9) << dv;
    // a wrong gamma to start from
    const WallStar other = detail::fan(1.225, 101325, 3.0, dv, [](double, double p) { return 1.4 * p; });
    EXPECT_NEAR(other.p / exact.p, 1, dv < -1300 ? 1e-1 : 1e-3) << dv;
  }
}

TEST(EmbedWallState, CollapsingStiffnessGivesAPressure) {
  for (const double floor : {-1e10, 0.0, 1.0})
    for (double dv = -1; dv > -5000; dv *= 1.3) {
      const WallStar s =
          wall_star(21.5, 7.4e5, 4e6, 2.6, dv, false, [&](double r, double) { return r > 0.999 ? 4e6 : floor; });
      EXPECT_GE(s.p, 0) << dv;
      EXPECT_LE(s.p, 7.4e5) << dv;
      EXPECT_GT(s.compress, 0) << dv;
    }
}

TEST(EmbedWallState, JwlRecedes) {  // F10c
  const Jwl tnt{371.2e9, 3.231e9, 4.15, 0.95, 0.30, 1630, 7e9};
  const double rho = 1400, p = 1e10;
  auto stiffness = [&](double r, double q) { return bulk_stiffness(tnt, rho * r, q); };
  for (const double u : {0., 5., 15., 19., 21., 100., 250., 400., 440., 500., 1000., 1500., 2000., 2500., 3000.}) {
    // isentrope by many small steps of ln rho
    double r = 1, q = p, v = 0;
    const double ds = 1e-5;
    while (v < u && q > 0) {
      const double mid = q - 0.5 * ds * stiffness(r, q), rm = r * std::exp(-0.5 * ds), K = stiffness(rm, mid);
      v += ds * std::sqrt(K / (rho * rm));
      q -= ds * K;
      r *= std::exp(-ds);
    }
    const WallStar s = wall_star(rho, p, bulk_stiffness(tnt, rho, p), 1 / tnt.omega, -u, false, stiffness);
    EXPECT_GE(s.p, 0);
    const double band = u < 450 ? 1e-3 : 5e-3;
    EXPECT_NEAR(s.p / q, 1, band) << u;
    EXPECT_NEAR(s.compress / r, 1, band) << u;
  }
  for (const double u : {2e4, 1e6}) {
    const WallStar s = wall_star(rho, p, bulk_stiffness(tnt, rho, p), 1 / tnt.omega, -u, false, stiffness);
    EXPECT_GE(s.p, 0);
    EXPECT_LT(s.p, 1e8);
    EXPECT_GT(s.compress, 0);
  }
}

TEST(EmbedWallState, GasWithACovolumeIsAnIdealGasInTheVolumeThatIsLeft) {
  const double gamma = 1.25, b = 1e-3, rho = 400, p = 3e8, reduced = rho / (1 - b * rho);
  const NobleAbel dense{gamma, b};
  const FiveEquation<NobleAbel, NobleAbel> mix{dense, dense};
  const WallGas<MixtureAtWall<FiveEquation<NobleAbel, NobleAbel>>> gas_at{{mix}};
  std::array<double, Prim::count> w{};
  w[Prim::arho1] = rho, w[Prim::p] = p, w[Prim::alpha1] = 1;
  EXPECT_NEAR(gas_at.stiffness(w) / (rho * std::pow(sound_speed(dense, rho, p), 2)), 1, 1e-13);
  for (const double u : {-900.0, -300.0, 300.0, 1500.0}) {
    const auto star = gas_at.at_wall(w, {1, 0, 0}, {u, 0, 0});
    const double ps = star.w[Prim::p], rs = star.w[Prim::arho1];
    if (u > 0) {  // the wall moves into gas that lies in front of it: Rankine-Hugoniot
      EXPECT_NEAR((ps - p) * (1 / rho - 1 / rs) / (u * u), 1, 1e-10) << u;
      EXPECT_NEAR(
          (internal_energy(dense, rs, ps) - internal_energy(dense, rho, p)) / (0.5 * (ps + p) * (1 / rho - 1 / rs)), 1,
          1e-10)
          << u;
    } else {  // p (1/rho - b)^gamma and u + 2 c' rho'/... of the ideal gas in what is left
      const double c = std::sqrt(gamma * p / reduced), share = 1 + 0.5 * (gamma - 1) * u / c;
      EXPECT_NEAR(ps / (p * std::pow(share, 2 * gamma / (gamma - 1))), 1, 1e-10) << u;
      EXPECT_NEAR(std::pow((1 / rho - b) / (1 / rs - b), gamma) / (ps / p), 1, 1e-10) << u;
    }
  }
}

TEST(EmbedWallState, WallStateMovesWithTheWallAndSlips) {
  const TwoGases mix;
  const WallGas<MixtureAtWall<TwoGases>> gas_at{{mix}};
  const auto w = gas(1.225, {30, 20, 10}, 101325);
  const Vec3 n = unit(Vec3{1, 2, -2}), wall{40, -20, 5};
  const auto star = gas_at.at_wall(w, n, wall).w;
  const Vec3 v{star[Prim::v], star[Prim::v_y], star[Prim::v_z]}, before{30, 20, 10};
  EXPECT_NEAR(dot(v, n), dot(wall, n), 1e-12);
  EXPECT_NEAR(norm((v - dot(v, n) * n) - (before - dot(before, n) * n)), 0, 1e-12);
  EXPECT_EQ(gas_at.at_wall(w, n, before).w, w);
}

}  // namespace
}  // namespace bw::cfd
