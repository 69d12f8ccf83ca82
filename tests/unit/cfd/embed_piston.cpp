// SPDX-License-Identifier: Apache-2.0
// F10 and F10b: pistons against exact solutions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "embed_block.h"

namespace bw::cfd {
namespace {

using namespace test;

// --- F10b: smooth piston, exact simple wave
// --------------------------------------------------------------------------------
struct SmoothPiston {
  double A, T = 0.8, x0 = 0.013;
  double v(double t) const { return t <= 0 || t >= T ? 0 : A * std::pow(std::sin(M_PI * t / T), 2); }
  double x(double t) const {
    const double s = std::clamp(t, 0.0, T);
    return x0 + A * (s / 2 - T / (4 * M_PI) * std::sin(2 * M_PI * s / T));
  }
  double p(double t) const { return std::pow(1 + 0.2 * v(t) / std::sqrt(1.4), 7); }
};

double wall_pressure_error(double A, int cells, WallTreatment treatment = WallTreatment::half_riemann) {
  const SmoothPiston piston{A};
  const double h = 2.0 / cells;
  OneBlock<TwoGases> b({{-0.5, 0, 0}, {h, 1, 1}, {cells, 1, 1}}, {}, GhostRule::mirror, treatment);
  b.paint([](const Vec3&) { return gas(1, {}, 1); });
  b.place(box({-5, -1, -1}, {piston.x(0), 2, 2}));
  double t = 0, sum = 0, v_last = 0, dt_last = 0;
  const double end = 0.7;
  while (t < end - 1e-12) {
    const double dt = std::min(0.4 * h / (std::sqrt(1.4) + std::abs(A) + 0.3), end - t);
    // over the window the wall moves straight to its place at the end
    set_velocity(b.surface, {(piston.x(t + dt) - piston.x(t)) / dt, 0, 0});
    if (treatment == WallTreatment::mirror)
      b.acceleration.assign(b.surface.x.size(), {2 * (b.surface.v[0].x - v_last) / (dt + dt_last), 0, 0});
    v_last = b.surface.v[0].x, dt_last = dt;
    b.place(b.surface);
    b.advance(dt);
    int first = 0;
    while (b.blocked(0, 0, first)) ++first;
    const Vec3 v = b.surface.v[0];
    const double p = b.cut.load({first, 0, 0}, {piston.x(t) + 0.5 * dt * v.x, 0.5, 0.5}, {1, 0, 0}, v).p;
    const double error = p / piston.p(t + 0.5 * dt) - 1;
    sum += error * error * dt;
    b.move(dt);
    t += dt;
  }
  return std::sqrt(sum / end);
}

TEST(EmbedPiston, SmoothPistonIsSecondOrder) {
  const double reference[] = {1.27e-3, 3.98e-4, 1.02e-4}, amplitude[] = {-0.5, -0.3, 0.3};
  for (int i = 0; i < 3; ++i) {
    const double e1 = wall_pressure_error(amplitude[i], 100), e2 = wall_pressure_error(amplitude[i], 200),
                 e4 = wall_pressure_error(amplitude[i], 400);
    std::printf("A = %g: rms error %.3e %.3e %.3e, order %.2f %.2f\n", amplitude[i], e1, e2, e4, std::log2(e1 / e2),
                std::log2(e2 / e4));
    const std::string name = amplitude[i] > 0 ? "p" : "m";
    const std::string key = name + (std::abs(amplitude[i]) > 0.4 ? "0.5" : "0.3");
    RecordProperty(key + "_error_100", fmt::format("{:.3e}", e1));
    RecordProperty(key + "_short_of_order_2", fmt::format("{:.3f}", std::max(0.0, 2 - std::log2(e1 / e4) / 2)));
    EXPECT_LT(e1, 1.2 * reference[i]);
    EXPECT_GT(std::log2(e1 / e4) / 2, 1.9);
  }
}

/// The other treatments of cut links, of which one is to be of first and one of second order.
TEST(EmbedPiston, OtherTreatmentsOfSmoothPistons) {
  for (const WallTreatment treatment : {WallTreatment::first_order, WallTreatment::mirror})
    for (const double A : {-0.5, -0.3, 0.3}) {
      double e[3];
      for (int i = 0; i < 3; ++i) e[i] = wall_pressure_error(A, 100 << i, treatment);
      const double order = std::log2(e[0] / e[2]) / 2;
      std::printf("A = %g: rms error %.3e %.3e %.3e, order %.2f\n", A, e[0], e[1], e[2], order);
      const bool is_first = treatment == WallTreatment::first_order;
      const std::string key =
          fmt::format("{}_{}{:g}", is_first ? "first_order" : "mirror", A > 0 ? "p" : "m", std::abs(A));
      RecordProperty(key + "_error_100", fmt::format("{:.3e}", e[0]));
      RecordProperty(key + "_short_of_order", fmt::format("{:.3f}", std::max(0.0, (is_first ? 1 : 2) - order)));
      EXPECT_LT(e[2], e[0]);
    }
}

// --- F10: impulsive piston
// -------------------------------------------------------------------------------------------------
struct Plateau {
  double p, rho, shock;  // mid of the plateau; place of the shock (compression)
  double mass_error;     // in cell volumes of undisturbed air
  double overheating;    // temperature at the wall over that of the plateau - 1
  bool finite;
};

/// Direction of motion at `angle` to x in a 2-D strip; the wall starts at 0.5 along it.
Plateau impulsive(double u, double angle, int cells) {
  const double h = 2.0 / cells, end = u >= 1000 || u <= -1000 ? 2e-4 : 1e-3;
  const bool flat = angle == 0;
  const Vec3 n{std::cos(angle), std::sin(angle), 0}, along{-n.y, n.x, 0};
  OneBlock<TwoGases> b({{0, 0, 0}, {h, h, 1}, {cells, flat ? 1 : cells / 2, 1}}, {}, GhostRule::copy);
  b.paint([](const Vec3&) { return gas(1.225, {}, 101325); });
  WetSurface s = box({-5, -9, -1}, {0, 9, 2});
  const double start = 0.5;
  for (Vec3& x : s.x) x = (start + x.x) * n + x.y * along + Vec3{0, 0, x.z};
  set_velocity(s, u * n);
  b.place(s);
  const double mass0 = b.mass();
  double t = 0;
  while (t < end - 1e-15) {
    const double dt = std::min({0.6 / std::max(b.largest_rate(), std::abs(u) / h), 0.4 * h / std::abs(u), end - t});
    b.place(b.surface);
    b.advance(dt);
    b.move(dt);
    t += dt;
  }
  Plateau r{0, 0, 0, 0, 0, true};
  const double wall = start + u * end, c0 = 340.294;
  const double us = u > 0 ? 0.6 * u + std::sqrt(0.36 * u * u + c0 * c0) : c0;  // shock speed
  const double front = start + us * end;
  const double probe =
      u > 0 ? 0.5 * (wall + front) : std::max(0.5 * (wall + start + (c0 + 1.2 * u) * end), wall + 3 * h);
  const Vec3 at = probe * n + (flat ? 0.5 : 0.35) * along * (flat ? 0.0 : 1.0);
  const int j = flat ? 0 : std::clamp(int(at.y / h), 0, cells / 2 - 1);
  const auto w = b.get(0, j, std::clamp(int(at.x / h), 0, cells - 1));
  r.p = w[Prim::p], r.rho = w[1];
  const Vec3 near = (wall + 0.7 * h) * n + (flat ? 0.0 : 0.35) * along;
  const auto ww =
      b.get(0, flat ? 0 : std::clamp(int(near.y / h), 0, cells / 2 - 1), std::clamp(int(near.x / h), 0, cells - 1));
  r.overheating = w[1] / w[Prim::p] * ww[Prim::p] / ww[1] - 1;
  r.mass_error = (b.mass() - mass0) / (1.225 * h);
  b.for_cells([&](int k, int jj, int i) {
    r.finite = r.finite && (b.blocked(k, jj, i) || (b.get(k, jj, i)[1] > 0 && b.get(k, jj, i)[Prim::p] > 0));
  });
  return r;
}

struct Case {
  double u, p, rho;
};
const Case table[] = {{50, 124086.35, 1.415446},    {100, 151004.02, 1.625925},  {340, 351540.23, 2.822273},
                      {1000, 1681308.65, 5.452307}, {2000, 6097251.9, 6.702099}, {-50, 82232.10, 1.055281},
                      {-100, 66309.87, 0.904917},   {-340, 21281.54, 0.401842}};

TEST(EmbedPiston, ImpulsiveAlongTheGrid) {
  for (const Case& c : table) {
    const Plateau r = impulsive(c.u, 0, 400);
    std::printf("u %6g: p %.5g (%+.2f %%) rho %.5g (%+.2f %%) at the wall %+.1f %%, mass error %+.2f cells\n", c.u, r.p,
                100 * (r.p / c.p - 1), r.rho, 100 * (r.rho / c.rho - 1), 100 * r.overheating, r.mass_error);
    EXPECT_NEAR(r.p / c.p, 1, 0.01) << c.u;
    EXPECT_NEAR(r.rho / c.rho, 1, 0.01) << c.u;
    EXPECT_TRUE(r.finite);
  }
  EXPECT_TRUE(impulsive(-1000, 0, 400).finite);
  EXPECT_TRUE(impulsive(-2000, 0, 400).finite);
}

TEST(EmbedPiston, ImpulsiveAt30Degrees) {
  for (const Case& c : table) {
    if (std::abs(c.u) == 50 || c.u == 2000) continue;
    const Plateau r = impulsive(c.u, M_PI / 6, 160);
    std::printf("30 deg, u %6g: p %.5g (%+.2f %%) rho %.5g (%+.2f %%) at the wall %+.1f %%\n", c.u, r.p,
                100 * (r.p / c.p - 1), r.rho, 100 * (r.rho / c.rho - 1), 100 * r.overheating);
    EXPECT_NEAR(r.p / c.p, 1, 0.02) << c.u;
    EXPECT_NEAR(r.rho / c.rho, 1, 0.02) << c.u;
    EXPECT_TRUE(r.finite);
  }
}

}  // namespace
}  // namespace bw::cfd
