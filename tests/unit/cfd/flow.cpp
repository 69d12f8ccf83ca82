// SPDX-License-Identifier: Apache-2.0
// Whole flows, from a case's text to sums over the domain: conservation, invariants, equality of ways to the same
// result.
#include <cmath>
#include <cstring>

#include "cfd/output.h"
#include "common/app/machine.h"
#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

TEST(Blocks, DivideAnyNumberOfCells) {
  for (int n : {1, 4, 16, 64, 97, 100, 208, 250, 256, 400, 1009}) {
    const auto b = choose_block({n, n, n});
    for (int d = 0; d < 3; ++d) EXPECT_EQ(n % b[d], 0) << n;
    if (n >= 16 && n % 2 == 0) {
      EXPECT_LE(b[1], 40) << n;
    }
  }
}

TEST(Conservation, ClosedBoxOfTwoMaterials) {
  Flow f(grid("[24, 20, 12]", "[0.6, 0.5, 0.3]") + air_and_tnt + hot_ball);
  const FluidSums before = f.sums();
  f.steps(25);
  const FluidSums after = f.sums();
  const Booked b = f.books.booked(f.m);
  EXPECT_EQ(b.floors, 0);
  for (int q : {int(Cons::arho1), int(Cons::arho2), int(Cons::rhoE)})
    EXPECT_NEAR(after.U[q] + b.cleaned[q], before.U[q],
                1e-13 * std::abs(before.U[Cons::rhoE] * (q == Cons::rhoE) + before.U[q]));
  for (int d = 0; d < 3; ++d) {
    double sides = 0;
    for (int s = 0; s < 6; ++s) sides += (s % 2 ? 1 : -1) * b.side[s][Cons::mom + d];
    EXPECT_NEAR(after.U[Cons::mom + d] + sides + b.cleaned[Cons::mom + d], before.U[Cons::mom + d],
                1e-11 * std::sqrt(after.U[Cons::rhoE] * after.U[0]));
  }
}

TEST(Conservation, PeriodicBoxKeepsMomentum) {
  Flow f(grid("[20, 16, 18]", "[0.6, 0.5, 0.5]", periodic_sides) + air_and_tnt + hot_ball);
  const FluidSums before = f.sums();
  f.steps(20);
  const FluidSums after = f.sums();
  const double scale = std::sqrt(after.U[Cons::rhoE] * after.U[0]);
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(after.U[Cons::mom + d], before.U[Cons::mom + d], 1e-11 * scale);
  EXPECT_NEAR(after.U[Cons::rhoE] + f.books.booked(f.m).cleaned[Cons::rhoE], before.U[Cons::rhoE],
              1e-13 * before.U[Cons::rhoE]);
}

TEST(Invariants, UniformFlowStaysUniform) {
  Flow f(grid("[16, 20, 10]", "[1, 1, 1]", periodic_sides) + air_flow);
  const std::vector<double> before = f.bits();
  f.steps(10);
  const std::vector<double> after = f.bits();
  for (size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(after[i], before[i], 1e-13 * std::abs(before[i]) + 1e-15);
}

TEST(Invariants, ContactsKeepPressureAndVelocity) {  // VALIDATION F5
  Flow f(grid("[40, 1, 1]", "[1, 0.025, 0.025]", R"(x_lower = "periodic", x_upper = "periodic")") + air_and_tnt +
         R"([[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
velocity = [100, 0, 0]
[[fluid.region]]
shape = {kind = "box", lower = [0.25, -1, -1], upper = [0.6, 1, 1]}
material = "TNT"
density = 50
pressure = 101325
velocity = [100, 0, 0]
)");
  f.steps(200);
  const Departure worst = departure(f, 100, 100);
  EXPECT_LT(worst.p, 1e-11);
  EXPECT_LT(worst.v, 1e-11);
}

const std::string sharp = "scheme = {interface = \"sharp\"}\n";

/// A ball of products carried obliquely: p and v stay, masses too; how many cells hold both materials.
int carry_a_ball(const std::string& scheme) {
  Flow f(grid("[24, 24, 24]", "[1, 1, 1]", periodic_sides) + scheme + air_and_tnt + R"([[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
velocity = [100, 100, 100]
[[fluid.region]]
shape = {kind = "sphere", centre = [0.5, 0.5, 0.5], radius = 0.3}
material = "TNT"
density = 50
pressure = 101325
velocity = [100, 100, 100]
)");
  const FluidSums before = f.sums();
  f.steps(120);
  const Departure worst = departure(f, 100, 100);
  EXPECT_LT(worst.p, 1e-11);
  EXPECT_LT(worst.v, 1e-11);
  const Booked b = f.books.booked(f.m);
  for (int q : {int(Cons::arho1), int(Cons::arho2), int(Cons::rhoE)})
    EXPECT_NEAR(f.sums().U[q] + b.cleaned[q], before.U[q], 1e-12 * before.U[q]);
  int both = 0;
  for (int block : f.all())
    for (int c = 0; c < f.m.forest.shape().cells(); ++c) {
      const double alpha1 = f.m.state.block(block, Cons::alpha1)[c];
      both += alpha1 > 0.05 && alpha1 < 0.95;
    }
  return both;
}

TEST(Interface, SharpBallIsCarriedWithThinnerEdge) { EXPECT_LT(carry_a_ball(sharp), 0.7 * carry_a_ball("")); }

TEST(Interface, SharpFlowConserves) {
  Flow f(grid("[24, 20, 12]", "[0.6, 0.5, 0.3]") + sharp + air_and_tnt + hot_ball);
  const FluidSums before = f.sums();
  f.steps(25);
  const Booked b = f.books.booked(f.m);
  for (int q : {int(Cons::arho1), int(Cons::arho2), int(Cons::rhoE)})
    EXPECT_NEAR(f.sums().U[q] + b.cleaned[q], before.U[q], 1e-13 * std::abs(before.U[Cons::rhoE] * (q == Cons::rhoE) + before.U[q]));
}

const std::string charge = grid("[24, 24, 96]", "[0.3, 0.3, 1.2]") + lit_charge("[0.15, 0.15, 0.15]", 0.06);

TEST(Equal, AnyNumberOfThreads) {
  expect_equal_on_threads(charge, 12);
  expect_equal_on_threads(grid("[24, 24, 96]", "[0.3, 0.3, 1.2]") + sharp + lit_charge("[0.15, 0.15, 0.15]", 0.06), 12);
}

TEST(Equal, BlocksAtRestAreSkipped) { expect_rest_is_skipped(charge, 12); }

TEST(Detonation, ReleasesExactlyItsEnergy) {
  Flow f(charge);
  const double mass = f.sums().U[0], energy = f.sums().U[Cons::rhoE], stored = stored_energy(f.m);
  EXPECT_NEAR(mass, 1630 * 4.0 / 3 * M_PI * std::pow(0.06, 3), 0.003 * mass);  // sub-sampled sphere
  EXPECT_NEAR(stored, mass * f.m.setup.burn->q, 1e-12 * stored);
  while (f.m.state.t < f.m.setup.burn->t_all) f.steps(1);
  const Booked b = f.books.booked(f.m);
  const double left = stored_energy(f.m);  // in traces that ran ahead of the front
  EXPECT_LT(left, 1e-9 * stored);
  EXPECT_NEAR(f.sums().U[Cons::rhoE] + b.cleaned[Cons::rhoE] - b.floor_energy - energy + left, stored, 1e-13 * stored);
  EXPECT_EQ(b.floors, 0);
}

TEST(Detonation, UnburntExplosiveStaysAtRest) {
  Flow f(charge);
  f.m.setup.burn->start = 1;  // far away
  const std::vector<double> before = f.bits();
  f.steps(5);
  double worst = 0;
  const std::vector<double> after = f.bits();
  for (size_t i = 0; i < before.size(); ++i)
    worst = std::max(worst, std::abs(after[i] - before[i]) / (1 + std::abs(before[i])));
  EXPECT_LT(worst, 1e-9);
}

TEST(WrongInput, IsNamed) {
  const std::string box = grid("[8, 8, 8]", "[1, 1, 1]");
  expect_wrong(with(box + air_and_tnt, "density = 1.225", "density = -1"), "density");
  expect_wrong(with(box + air_and_tnt, "material = \"air\"", "material = \"argon\""), "argon");
  expect_wrong(with(box + air_and_tnt, "library = \"air\"", "library = \"soap\""), "soap");
  expect_wrong(with(box + air_and_tnt, "library = \"air\"\n", ""), "eos");
  expect_wrong(with(box + air_and_tnt, "pressure = 101325", "pressure = -5"), "pressure");
  expect_wrong(with(charge, "unburnt = true", "density = 1630"), "explosive");
  expect_wrong(with(charge, "points = [[0.15, 0.15, 0.15]]", "points = [[0.02, 0.15, 0.15]]"), "explosive");
}

}  // namespace
}  // namespace bw::cfd
