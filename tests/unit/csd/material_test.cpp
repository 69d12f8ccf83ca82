// SPDX-License-Identifier: Apache-2.0
// VALIDATION A.2 and S2: test vectors of the return map.
#include <gtest/gtest.h>

#include "solid_scene.h"

namespace bw::csd {
namespace {

const double mu = copper.mu, kappa = copper.volumetric.kappa;

/// Unit cube deformed by F.
Corners<double> cube(const Mat3& F) {
  return mapped(random_hex(1, 0), [&](const Vec3& X) { return F * X; });
}
Mat3 identity() { return Mat3::identity(); }

TEST(A2, SimpleShear) {
  OneElement<NeoHooke> e(copper_elastic(), random_hex(1, 0));
  for (double g : {0.01, 0.1, 1.0, 4.0}) {
    Mat3 F = identity();
    F(0, 1) = g;
    const Sym3 sigma = e.cauchy(cube(F), 3);  // J = 1: tau = sigma
    EXPECT_NEAR(sigma.xy, mu * g, 1e-13 * mu * (1 + g * g));
    EXPECT_NEAR(sigma.xx, 2.0 / 3 * mu * g * g, 1e-13 * mu * (1 + g * g));
    EXPECT_NEAR(sigma.yy, -mu * g * g / 3, 1e-13 * mu * (1 + g * g));
    EXPECT_NEAR(sigma.zz, -mu * g * g / 3, 1e-13 * mu * (1 + g * g));
  }
}

TEST(A2, UniaxialStrain) {
  OneElement<NeoHooke> e(copper_elastic(), random_hex(1, 0));
  for (double l : {0.7, 0.94, 1.05, 1.5}) {
    Mat3 F = identity();
    F(0, 0) = l;
    const Sym3 sigma = e.cauchy(cube(F), 0);
    const double s11 = 2.0 / 3 * mu * std::pow(l, -2.0 / 3) * (l * l - 1), p = 0.5 * kappa * (l - 1 / l);
    EXPECT_NEAR(sigma.xx, s11 / l + p, 1e-13 * kappa);
    EXPECT_NEAR(sigma.yy, -0.5 * s11 / l + p, 1e-13 * kappa);
  }
}

TEST(A2, LinearHardeningInOneStep) {  // step 4 in closed form, against the definition g(D) = 0
  OneElement<J2<LinearFlow>> e(copper_j2(), random_hex(1, 0));
  Mat3 F = identity();
  F(0, 1) = 0.1;
  const Trial<double> trial = e.point(cube(F), 0).trial;
  e.force(cube(F));
  const double D = e.eqps(0) / std::sqrt(2.0 / 3), mu_bar = mu * trial.iso * trial.third_trace;
  const double norm = mu * trial.iso * std::sqrt(trial.dev2);
  EXPECT_NEAR(norm - 2 * mu_bar * D - std::sqrt(2.0 / 3) * (400e6 + 100e6 * e.eqps(0)), 0, 1e-12 * norm);
  const Sym3 s = deviator(e.cauchy(cube(F), 0));  // on the yield surface now: f <= 0 after return
  EXPECT_NEAR(std::sqrt(1.5 * contract(s, s)), 400e6 + 100e6 * e.eqps(0), 1e-12 * norm);
}

TEST(A2, SaturationByNewtonMatchesLinear) {
  const LinearFlow linear{400e6, 100e6};
  SaturationFlow saturation;
  saturation.sigma_Y = 400e6, saturation.K_iso = 100e6, saturation.sigma_inf = 400e6, saturation.delta = 17;
  for (double norm : {0.4e9, 1e9, 20e9}) {
    const double a = linear.multiplier(norm, mu, 0.2), b = saturation.multiplier(norm, mu, 0.2);
    EXPECT_NEAR(a, b, 1e-12 * norm / mu);
  }
  saturation.sigma_inf = 715e6;
  const double D = saturation.multiplier(5e9, mu, 0.0), r = std::sqrt(2.0 / 3);
  EXPECT_NEAR(5e9 - 2 * mu * D - r * saturation.stress(r * D), 0, 1e-3);
  const double h = 1e-6;  // work is the integral of stress
  EXPECT_NEAR((saturation.work(0.3 + h) - saturation.work(0.3 - h)) / (2 * h), saturation.stress(0.3), 1e-6 * 715e6);
}

TEST(A2, IsochoricThirdTrace) {
  for (double s : {1e-6, 1e-3, 0.05, 0.3, 2.0, 30.0}) {  // s/mu = diag(a, b, -a-b)
    const double a = s, b = -0.3 * s, c = -a - b, q = a * a + b * b + c * c, r = a * b * c;
    const double x = isochoric_third_trace(q, r, 1 + std::sqrt(q));
    EXPECT_NEAR((a + x) * (b + x) * (c + x), 1, 4e-16 * (1 + x * x * x)) << s;
    EXPECT_GT(std::fmin(b, c) + x, 0);
  }
}

/// A plastic path with turning axes.
Mat3 path(double t) {
  Mat3 F = identity();
  F(0, 0) = 1 + 0.3 * t, F(1, 1) = 1 - 0.2 * t, F(0, 1) = 0.8 * std::sin(3 * t), F(1, 2) = 0.5 * t * t,
       F(2, 0) = -0.4 * t;
  return F;
}

TEST(A2, PlasticFlowIsIsochoric) {
  OneElement<J2<LinearFlow>> e(copper_j2(), random_hex(5, 0.1));
  std::vector<double> start;
  for (int i = 0; i < 8; ++i) start.push_back(det(load_sym<double>(e.at(i))));
  double worst = 0;
  for (int n = 1; n <= 2000; ++n) {
    const Mat3 F = path(n / 1000.0);
    e.force(mapped(e.X, [&](const Vec3& X) { return F * X; }));
    for (int i = 0; i < 8; ++i)
      worst = std::fmax(worst, std::fabs(det(load_sym<double>(e.at(i))) / start[size_t(i)] - 1));  // det C_p^-1
  }
  EXPECT_GT(e.eqps(0), 1);
  EXPECT_LT(worst, 1e-12);
  record("det_Cp_error", worst);
}

TEST(A2, DissipationIsNeverNegative) {
  OneElement<J2<LinearFlow>> e(copper_j2(), random_hex(5, 0.1));
  double before = 0;
  for (int n = 1; n <= 500; ++n) {
    const Mat3 F = path(2 * std::sin(n / 80.0));
    e.force(mapped(e.X, [&](const Vec3& X) { return F * X; }));
    EXPECT_GE(e.eqps(2), before);
    before = e.eqps(2);
  }
}

TEST(S2, ClosedElasticCycle) {  // lambda = 1.5 mu: nu = 0.3
  J2<LinearFlow> steel(Elastic(7800, 206e9, 0.3), LinearFlow{1e15, 0});
  double worst = 0;
  for (double e : {0.1, 0.5, 1.0}) {
    OneElement<J2<LinearFlow>> element(steel, random_hex(1, 0));
    const int n = 50;
    double a = 0, g = 0;
    const auto go = [&](double a1, double g1) {
      for (int i = 1; i <= n; ++i) {
        Mat3 F = identity();
        F(1, 1) = 1 + a + (a1 - a) * i / n;
        F(0, 1) = (g + (g1 - g) * i / n) * F(1, 1);
        element.force(cube(F));
      }
      a = a1, g = g1;
    };
    go(e, 0), go(e, e), go(0, e), go(0, 0);
    for (int i = 0; i < 8; ++i) worst = std::fmax(worst, largest(full(element.cauchy(cube(identity()), i))) / steel.mu);
  }
  EXPECT_LE(worst, 1e-13);
  record("residual_over_mu", worst);
}

}  // namespace
}  // namespace bw::csd
