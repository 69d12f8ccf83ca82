// SPDX-License-Identifier: Apache-2.0
// F13 a-c: what embedded walls must leave alone, to round-off.
#include <gtest/gtest.h>

#include "embed_block.h"

namespace bw::cfd {
namespace {

using namespace test;

/// Largest absolute value; a NaN is the largest of all.
void grow(double& worst, std::initializer_list<double> values) {
  for (const double a : values) worst = std::max(worst, std::isnan(a) ? 1e300 : std::abs(a));
}

TEST(EmbedInvariants, UniformFlowWithComovingWalls) {  // F13a
  OneBlock<TwoGases> b({{}, {0.05, 0.05, 0.05}, {20, 18, 16}}, {}, GhostRule::periodic);
  const Vec3 v{100, 50, 20};
  b.paint([&](const Vec3&) { return gas(1.2, v, 1e5); });
  WetSurface s = sphere({0.4, 0.45, 0.4}, 0.17, 6);
  WetSurface thin = plate({0.7, 0.45, 0.4}, {0.2, 0.3, 0}, {0, 0.1, 0.4}, 3),
             slab = box({0.1, 0.1, 0.1}, {0.13, 0.6, 0.6}, 2);
  rotate(slab, unit(Vec3{1, 2, 3}), 0.4, {0.1, 0.3, 0.3});
  append(s, thin);
  append(s, slab);
  set_velocity(s, v);
  b.place(s);
  double worst = 0;
  int64_t fresh = 0;
  const double dt = 2e-5;  // 0.04 cells
  for (int step = 0; step < 60; ++step) {
    b.advance(dt);
    fresh += int64_t(b.move(dt).fresh.size());
    b.for_cells([&](int k, int j, int i) {
      if (b.blocked(k, j, i)) return;
      const auto w = b.get(k, j, i);
      grow(worst,
           {w[1] / 1.2 - 1, w[Prim::v] / 100 - 1, w[Prim::v_y] / 50 - 1, w[Prim::v_z] / 20 - 1, w[Prim::p] / 1e5 - 1});
    });
  }
  EXPECT_LT(worst, 1e-12);
  EXPECT_GT(fresh, 300);
}

/// What stands in metal is in no book: not through the sides of the domain that a body goes through either.
TEST(EmbedInvariants, SidesAreBookedWhereTheyAreOpen) {
  for (const GhostRule rule : {GhostRule::mirror, GhostRule::copy}) {
    double side[2][6][Cons::count];
    for (const int wild : {0, 1}) {
      OneBlock<TwoGases> b({{}, {0.05, 0.05, 0.05}, {16, 12, 20}}, {}, rule);
      b.paint([](const Vec3& x) { return gas(1.2, {30, 20 * x.y, -10}, 1e5 * (1 + x.z)); });
      b.place(box({-0.2, 0.21, 0.33}, {1.1, 0.43, 0.62}, 4));  // from side to side along x
      b.for_cells([&](int k, int j, int i) {
        if (wild && b.blocked(k, j, i)) b.set(k, j, i, gas(7e3, {900, -400, 800}, 1e12));
      });
      b.change.book_sides = 63;
      b.advance(1e-6);
      for (int n = 0; n < 6; ++n) std::copy_n(b.change.side[n], int(Cons::count), side[wild][n]);
    }
    for (int n = 0; n < 6; ++n)
      for (int q = 0; q < Cons::count; ++q) EXPECT_EQ(side[0][n][q], side[1][n][q]) << n << " " << q;
  }
}

TEST(EmbedInvariants, GasAtRestInTiltedBox) {  // F13b
  OneBlock<TwoGases> b({{}, {0.05, 0.05, 0.05}, {20, 20, 20}}, {});
  b.paint([](const Vec3&) { return gas(1.2, {}, 1e5); });
  WetSurface s = box({0.2, 0.25, 0.2}, {0.8, 0.75, 0.8}, 3);
  for (auto& q : s.quads) q = {q[0], q[3], q[2], q[1]};  // the gas is inside
  rotate(s, unit(Vec3{1, -1, 2}), 0.5, {0.5, 0.5, 0.5});
  s.flags.assign(s.quads.size(), coupling::face_thin);
  b.place(s);
  ASSERT_TRUE(b.cuts.any());
  double worst = 0;
  for (int step = 0; step < 50; ++step) b.advance(4e-5);
  b.for_cells([&](int k, int j, int i) {
    const auto w = b.get(k, j, i);
    grow(worst, {w[1] / 1.2 - 1, w[Prim::p] / 1e5 - 1, w[Prim::v] / 340, w[Prim::v_y] / 340, w[Prim::v_z] / 340});
  });
  EXPECT_LT(worst, 1e-12);
}

/// Sound of 1e-6 around tilted thin boxes dies away: planes at 45 degrees, edges and corners prolong nothing that
/// grows.
TEST(EmbedInvariants, SoundBesideTiltedWallsDecays) {
  const struct {
    Vec3 lower, upper, axis;
    double angle;
  } scenes[] = {{{0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, {0, 0, 1}, 0.7854},
                {{0.25, 0.25, 0.3}, {0.75, 0.75, 0.7}, {1, 2, -3}, 1.065},
                {{0.45, 0.46, 0.2}, {0.52, 0.51, 0.8}, {1, 2, 3}, 0.576}};
  for (const auto& scene : scenes) {
    OneBlock<TwoGases> b({{}, {1.0 / 24, 1.0 / 24, 1.0 / 24}, {24, 24, 24}}, {});
    b.paint([](const Vec3& x) {
      const double wave = 1e-6 * std::sin(17 * x.x + 3) * std::cos(29 * x.y) * std::sin(41 * x.z + 1);
      return gas(1.2 * (1 + wave), {}, 1e5 * (1 + 1.4 * wave));
    });
    WetSurface s = box(scene.lower, scene.upper, 1);
    rotate(s, unit(scene.axis), scene.angle, {0.5, 0.5, 0.5});
    s.flags.assign(s.quads.size(), coupling::face_thin);
    b.place(s);
    double worst = 0;
    for (int step = 0; step < 300; ++step) b.advance(0.9 / b.largest_rate());
    b.for_cells([&](int k, int j, int i) { grow(worst, {b.get(k, j, i)[Prim::p] / 1e5 - 1}); });
    EXPECT_LT(worst, 2e-6) << scene.angle;
  }
}

/// Two sides of a closed thin surface at 1 and 100 bar; returns the largest change of either state.
double leak(const WetSurface& s, int steps, int n = 12) {
  OneBlock<TwoGases> b({{}, {1.0 / n, 1.0 / n, 1.0 / n}, {n, n, n}}, {});
  CutMap sides;  // which side, from the same faces as a closed body
  WetSurface closed = s;
  closed.flags.assign(s.quads.size(), 0);
  scan(closed, b.lattice, sides);
  b.for_cells([&](int k, int j, int i) {
    b.set(k, j, i, sides.blocked({i, j, k}) ? gas(100, {}, 1e7) : gas(1.2, {}, 1e5));
  });
  WetSurface thin = s;
  thin.flags.assign(s.quads.size(), coupling::face_thin);
  b.place(thin);
  for (int step = 0; step < steps; ++step) b.advance(0.3 / b.largest_rate());
  double worst = 0;
  b.for_cells([&](int k, int j, int i) {
    const auto w = b.get(k, j, i);
    const bool high = sides.blocked({i, j, k});
    grow(worst, {w[1] / (high ? 100 : 1.2) - 1, w[Prim::p] / (high ? 1e7 : 1e5) - 1, w[Prim::v] / 340,
                 w[Prim::v_y] / 340, w[Prim::v_z] / 340});
  });
  return worst;
}

TEST(EmbedInvariants, ThinPlateDoesNotLeak) {  // F13c
  WetSurface tilted = box({-1, -1, -1}, {0.47, 2, 2}, 1);
  rotate(tilted, unit(Vec3{0, 0.3, 1}), 0.37, {0.5, 0.5, 0.5});
  EXPECT_LT(leak(tilted, 200), 1e-12);
  EXPECT_LT(leak(box({-1, -1, -1}, {0.5, 2, 2}, 5), 200), 1e-12);     // on cell faces
  EXPECT_LT(leak(box({-1, -1, -1}, {0.625, 2, 2}, 24), 200), 1e-12);  // on centres, nodes too
  EXPECT_LT(leak(sphere({0.5, 0.5, 0.5}, 0.3, 5), 200), 1e-12);
  EXPECT_LT(leak(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, 3), 200), 1e-12);
}
TEST(EmbedInvariants, ThinPlateDoesNotLeakInTenThousandSteps) {
  EXPECT_LT(leak(sphere({0.5, 0.5, 0.5}, 0.31, 4), 10000, 8), 1e-12);
}

TEST(EmbedInvariants, MovingThinPlateKeepsTheTracerOnItsSide) {  // F13c, moving
  OneBlock<TwoGases> b({{}, {0.05, 0.05, 1}, {30, 16, 1}}, {});
  WetSurface s = plate({0.5, 0.4, 0.5}, {-0.35, 2, 0}, {0, 0, 3}, 3);
  for (auto& q : s.quads) q = {q[0], q[3], q[2], q[1]};
  const Vec3 n = unit(coupling::area_vector(s.x, s.quads[0]));
  b.paint([&](const Vec3& x) { return dot(x - Vec3{0.5, 0.4, 0.5}, n) > 0 ? gas(1.2, {}, 1e5) : gas_1(1.2, {}, 1e5); });
  b.place(s);
  double t = 0, crossed = 0;
  int64_t fresh = 0;
  for (int step = 0; step < 400; ++step) {
    const Vec3 v = 150 * std::sin(2 * M_PI * t / 6e-3) * Vec3{1, 0, 0};
    set_velocity(b.surface, v);
    b.place(b.surface);
    const double dt = 0.4 / b.largest_rate();
    b.advance(dt);
    fresh += int64_t(b.move(dt).fresh.size());
    t += dt;
    const Vec3 on_plate = b.surface.x[0];
    b.for_cells([&](int k, int j, int i) {
      const auto w = b.get(k, j, i);
      const bool ahead = dot(b.lattice.centre({i, j, k}) - on_plate, n) > 0;
      if (ahead)
        grow(crossed, {w[0], w[Prim::alpha1]});
      else
        grow(crossed, {w[1], w[Prim::alpha1] - 1});
    });
  }
  EXPECT_EQ(crossed, 0);
  EXPECT_GT(fresh, 50);
  std::printf("refilled %ld cells, mass added %.3g removed %.3g of %.3g kg\n", long(fresh), b.added, b.removed,
              b.mass());
}

}  // namespace
}  // namespace bw::cfd
