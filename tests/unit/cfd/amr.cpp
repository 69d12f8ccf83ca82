// SPDX-License-Identifier: Apache-2.0
// Blocks of several levels: the tree, ghosts across levels, fluxes at their faces, and the state when the grid changes.
#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "cfd/adapt.h"
#include "cfd/amr/levels.h"
#include "cfd/amr/transfer.h"
#include "cfd/output.h"
#include "common/app/machine.h"
#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

std::string amr(int levels, const std::string& more = "") {
  return "[fluid.amr]\nlevels = " + std::to_string(levels) + "\n" + more;
}
std::string fine_ball(int level) {
  return "[[fluid.amr.region]]\nshape = {kind = \"sphere\", centre = [0.35, 0.4, 0.3], radius = 0.1}\nlevel = " + std::to_string(level) + "\n";
}

/// Moves the fine ball of a flow along a diagonal, around the corners.
void move_ball(Flow& f, int step) {
  auto& ball = std::get<SphereRegion>(f.m.refine->region.front().shape);
  for (int d = 0; d < 3; ++d) ball.centre[d] = std::fmod(0.35 + 0.06 * step + 0.1 * d, 1.0);
}

/// Blocks touch at most one level away and fill the domain, and each neighbour knows the block in turn.
void expect_sound(const Forest& f) {
  double volume = 0;
  for (int b = 0; b < f.local_blocks(); ++b) {
    volume += f.shape(b).cell_volume() * f.shape(b).cells();
    for (int o : f.around(b)) {
      EXPECT_LE(std::abs(f.level(b) - f.level(o)), 1);
      const auto back = f.around(o);
      EXPECT_TRUE(std::find(back.begin(), back.end(), b) != back.end());
    }
    const Vec3 centre = f.lower(b) + 0.5 * f.extent(b);
    EXPECT_EQ(f.find(centre).block, b);
  }
  const Vec3 size = f.size().upper - f.size().lower;
  EXPECT_NEAR(volume, size.x * size.y * size.z, 1e-12 * volume);
}

class Directions : public testing::TestWithParam<const char*> {};
TEST_P(Directions, BalancedForest) {
  Flow f(grid(GetParam(), "[1, 1, 1]", periodic_sides) + amr(3, "follow_flow = false\n" + fine_ball(3)) + air_flow);
  int finest = 0;
  for (int step = 0; step < 12; ++step) {
    expect_sound(f.m.forest);
    for (int b : f.all()) finest = std::max(finest, f.m.forest.level(b));
    move_ball(f, step);
    adapt(f.m, f.sweep, f.books);
  }
  EXPECT_EQ(finest, 3);
}
INSTANTIATE_TEST_SUITE_P(Cells, Directions, testing::Values("[32, 1, 1]", "[1, 32, 1]", "[32, 1, 32]", "[32, 32, 1]", "[16, 32, 16]"));

TEST(Levels, UniformFlowStaysExact) {
  Flow f(grid("[32, 32, 16]", "[1, 1, 1]", periodic_sides) + amr(2, "follow_flow = false\nevery = 2\n" + fine_ball(2)) + air_flow);
  double U[Cons::count];
  for (int q = 0; q < Cons::count; ++q) U[q] = f.m.state.block(0, q)[0];
  int changes = 0;
  for (int step = 0; step < 10; ++step) {
    move_ball(f, step);
    const int64_t blocks = f.m.forest.global_blocks();
    f.steps(1);
    changes += f.m.forest.global_blocks() != blocks;
  }
  EXPECT_GE(changes, 3);
  const size_t cells = size_t(f.m.forest.shape().cells());
  double worst = 0;
  for (int b : f.all())
    for (int q = 0; q < Cons::count; ++q)
      for (size_t c = 0; c < cells; ++c) worst = std::max(worst, std::abs(f.m.state.block(b, q)[c] - U[q]) / (std::abs(U[q]) + 1e-2));
  testing::Test::RecordProperty("U_change", fmt::format("{:.3g}", worst));
  EXPECT_LT(worst, 1e-13);
}

/// 200 steps of a burst with a grid that changes every second one: what is in the box stays in it.
void expect_kept(Flow& f, int steps) {
  const FluidSums before = f.sums();
  int64_t least = f.m.forest.global_blocks(), most = least;
  for (int step = 0; step < steps; ++step) {
    move_ball(f, step / 2);
    f.steps(1);
    least = std::min(least, f.m.forest.global_blocks()), most = std::max(most, f.m.forest.global_blocks());
  }
  EXPECT_GT(most, least);
  const FluidSums after = f.sums();
  const Booked b = f.books.booked(f.m);
  EXPECT_EQ(b.floors, 0);
  double worst = 0;
  for (int q : {int(Cons::arho1), int(Cons::arho2), int(Cons::rhoE)})
    worst = std::max(worst, std::abs((after.U[q] + b.cleaned[q]) / before.U[q] - 1));
  testing::Test::RecordProperty("mass_energy_change", fmt::format("{:.3g}", worst));
  EXPECT_LT(worst, 1e-13);
  for (int d = 0; d < 3; ++d) {
    double sides = 0;
    for (int s = 0; s < 6; ++s) sides += (s % 2 ? 1 : -1) * b.side[s][Cons::mom + d];
    EXPECT_NEAR(after.U[Cons::mom + d] + sides + b.cleaned[Cons::mom + d], before.U[Cons::mom + d],
                1e-11 * std::sqrt(after.U[Cons::rhoE] * after.U[0]));
  }
}
TEST(Levels, ClosedBoxKeepsMassMomentumEnergy) {
  Flow f(grid("[16, 16, 16]", "[1, 1, 1]") + amr(2, "block = 8\nevery = 2\nfollow_flow = false\n" + fine_ball(2)) + air_and_tnt + hot_ball);
  expect_kept(f, 200);
}
TEST(Levels, PlaneKeepsMassMomentumEnergy) {
  Flow f(grid("[32, 32, 1]", "[1, 1, 0.01]") + amr(3, "block = 8\nevery = 2\n" + fine_ball(3)) + air_and_tnt +
         R"([[fluid.region]]
shape = {kind = "sphere", centre = [0.31, 0.3, 0.005], radius = 0.17}
material = "TNT"
density = 400
pressure = 2e8
)");
  expect_kept(f, 200);
}
/// A shock in gas that passes from blocks where it is alone into blocks with another gas near: one flux for both.
TEST(Levels, ShockBesideAnotherGasKeepsMassAndEnergy) {
  Flow f(grid("[64, 16, 1]", "[1, 0.25, 0.015625]") + amr(1, "block = 8\n") + R"([[fluid.material]]
name = "a"
eos = {kind = "ideal_gas", gamma = 1.5}
[[fluid.material]]
name = "b"
eos = {kind = "ideal_gas", gamma = 1.4}
[[fluid.region]]
shape = {kind = "everywhere"}
material = "a"
density = 1
pressure = 1
[[fluid.region]]
shape = {kind = "half_space", point = [0.5, 0, 0], normal = [1, 0, 0]}
material = "b"
density = 0.125
pressure = 0.1
)");
  const FluidSums before = f.sums();
  f.steps(73);
  const FluidSums after = f.sums();
  const Booked b = f.books.booked(f.m);
  for (int q : {int(Cons::arho1), int(Cons::arho2), int(Cons::rhoE)})
    EXPECT_NEAR((after.U[q] + b.cleaned[q]) / before.U[q], 1, 1e-13);
}

TEST(Levels, ContactsKeepPressureAndVelocity) {
  Flow f(grid("[32, 16, 16]", "[1, 0.5, 0.5]", periodic_sides) + amr(2, "block = 8\nevery = 2\nfollow_flow = false\n" + fine_ball(2)) + air_and_tnt +
         R"([[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
velocity = [100, 30, -20]
[[fluid.region]]
shape = {kind = "sphere", centre = [0.5, 0.3, 0.25], radius = 0.15}
material = "TNT"
density = 50
pressure = 101325
velocity = [100, 30, -20]
)");
  for (int step = 0; step < 60; ++step) {
    move_ball(f, step / 2);
    f.steps(1);
  }
  int levels = 0;
  for (int b : f.all()) levels |= 1 << f.m.forest.level(b);
  const Departure worst = departure(f, 100, 100);
  EXPECT_EQ(levels, 7);
  testing::Test::RecordProperty("p_change", fmt::format("{:.3g}", worst.p));
  testing::Test::RecordProperty("v_change", fmt::format("{:.3g}", worst.v));
  EXPECT_LT(worst.p, 1e-10);
  EXPECT_LT(worst.v, 1e-10);
}

const std::string charge_with_levels = grid("[48, 16, 16]", "[1.2, 0.4, 0.4]") + amr(2, "block = 8\nevery = 3\n") + lit_charge("[0.15, 0.15, 0.15]", 0.06);

TEST(Levels, BurnReleasesExactlyItsEnergy) {
  Flow f(charge_with_levels);
  const double energy = f.sums().U[Cons::rhoE], stored = stored_energy(f.m);
  while (f.m.state.t < 0.5 * f.m.setup.burn->t_all) f.steps(1);
  const auto released = [&] {
    const Booked b = f.books.booked(f.m);
    return f.sums().U[Cons::rhoE] + b.cleaned[Cons::rhoE] - b.floor_energy - energy + stored_energy(f.m);
  };
  EXPECT_NEAR(released(), stored, 1e-13 * stored);
  while (f.m.state.t < f.m.setup.burn->t_all) f.steps(1);
  EXPECT_NEAR(released(), stored, 1e-13 * stored);
  EXPECT_LT(stored_energy(f.m), 1e-9 * stored);
}

/// The grid changes as told, whatever the rules want.
void change(Flow& f, int8_t wish) {
  exchange_state(f.m.forest, f.m.state);
  const auto origins = f.m.forest.adapt(std::vector<int8_t>(size_t(f.m.forest.local_blocks()), wish));
  transfer_state(f.m.forest, {f.m.setup.medium, f.m.setup.boundary, &*f.m.setup.burn}, origins, f.m.state);
  f.m.forest.settle();
  f.m.state.fit(f.m.forest);
  inspect(f.m, f.all());
  f.books.fit(f.m);
  f.books.refresh(f.m, f.all());
}

TEST(Levels, EnergyStillStoredIsCarriedOver) {
  Flow f(charge_with_levels);
  while (f.m.state.t < 0.3 * f.m.setup.burn->t_all) f.steps(1);
  const auto total = [&] { return f.sums().U[Cons::rhoE] + stored_energy(f.m); };
  const double before = total(), stored = stored_energy(f.m);
  ASSERT_GT(stored, 0.1 * before);
  ASSERT_LT(stored, 0.9 * before);
  for (const int8_t wish : {-1, 1, -1, -1, 1, 1}) {
    const int64_t blocks = f.m.forest.global_blocks();
    change(f, wish);
    EXPECT_NE(f.m.forest.global_blocks(), blocks);
    EXPECT_NEAR(total(), before, 1e-13 * before);
  }
  EXPECT_GT(std::abs(stored_energy(f.m) - stored), 1e-6 * stored);  // it is not the same: the front is sampled at other places
}

TEST(Levels, EqualForAnyNumberOfThreads) { expect_equal_on_threads(charge_with_levels, 15); }

TEST(Levels, BlocksAtRestAreSkipped) { expect_rest_is_skipped(charge_with_levels, 15); }

TEST(Levels, LinearProfilesGoThroughALevelJumpUnchanged) {  // ghosts of second order
  const double a[3] = {1, 2, 3}, b = 2.5;
  for (int d = 0; d < 3; ++d) {
    const double below[3] = {b - a[d], 0, 0}, above[3] = {b + a[d], 0, 0};
    EXPECT_LT(refine_indicator(1, below, b, above), 1e-28);
    const double jump[3] = {4 * b, 0, 0};
    EXPECT_GT(refine_indicator(1, below, b, jump), 0.05);
  }
  Flow f(grid("[32, 16, 16]", "[1, 0.5, 0.5]") + amr(1, "block = 8\nfollow_flow = false\n" + fine_ball(1)) + air_flow);
  const auto p_at = [](const Vec3& x) { return 1e5 * (1 + 0.3 * x.x + 0.2 * x.y - 0.1 * x.z); };
  for (int b : f.all()) {
    const BlockShape& s = f.m.forest.shape(b);
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          double W[Prim::most] = {}, U[Cons::most];
          W[Prim::arho1] = 1, W[Prim::alpha1] = 1;
          W[Prim::p] = p_at(f.m.forest.lower(b) + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z});
          std::visit([&](const auto& pair) { pair.to_conserved(W, U); }, f.m.setup.medium.mixture);
          for (int q = 0; q < Cons::count; ++q) f.m.state.block(b, q)[s.at(k, j, i)] = U[q];
        }
  }
  const Gather gather(f.m.forest, f.m.state, f.m.setup.boundary, f.m.setup.medium);
  LevelGhosts space;
  Patch patch(f.m.forest.shape());
  int jumps = 0;
  for (int b : f.all()) {
    if (!f.m.forest.at_jump(b)) continue;
    bool at_side = false;
    for (int s = 0; s < 6; ++s) at_side = at_side || f.m.forest.at_side(b, s / 2, s % 2);
    for (int o : f.m.forest.around(b))  // a coarse ghost's slope may reach a wall's mirror image
      for (int s = 0; s < 6; ++s) at_side = at_side || (f.m.forest.level(o) < f.m.forest.level(b) && f.m.forest.at_side(o, s / 2, s % 2));
    if (f.m.forest.at_side(b, 0, false) || f.m.forest.at_side(b, 0, true)) continue;
    gather.fill(b, patch, space);
    const BlockShape& s = patch.shape();
    for (int k = 2; k < s.n[2] - 2; ++k)
      for (int j = 2; j < s.n[1] - 2; ++j)
        for (int i = -2; i < s.n[0] + 2; ++i) {
          const Vec3 x = patch.lower + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z};
          ASSERT_NEAR(patch.row(Prim::p, k, j)[i], p_at(x), 1e-9 * p_at(x)) << i << " " << j << " " << k;
        }
    ++jumps;
  }
  EXPECT_GT(jumps, 4);
}

}  // namespace
}  // namespace bw::cfd
