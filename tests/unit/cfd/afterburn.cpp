// SPDX-License-Identifier: Apache-2.0
// Products that burn on: what is released, when, and that it is booked.
#include "cfd/source/afterburn.h"

#include "cfd/eos/library.h"
#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

const std::string closed_box = R"(
[fluid]
lower = [0, 0, 0]
upper = [0.2, 0.2, 1.2]
cells = [16, 16, 96]
[[fluid.material]]
name = "air"
library = "air"
[[fluid.material]]
name = "TNT"
library = "TNT"
[[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
[[fluid.region]]
shape = {kind = "sphere", centre = [0.1, 0.1, 0.15], radius = 0.05}
material = "TNT"
density = 80
pressure = 1e8
[fluid.afterburn]
material = "TNT"
)";

/// Energy gained less what was booked (with traces removed at the interface), over all energy.
double unbooked(Flow& flow, int steps) {
  const double before = flow.sums().U[Cons::rhoE];
  flow.steps(steps);
  const double gained = flow.sums().U[Cons::rhoE] - before;
  const Booked b = flow.books.booked(flow.m);
  const double booked = b.afterburn - b.cleaned[Cons::rhoE];
  EXPECT_GT(booked, 0.01 * before);
  return std::abs(gained - booked) / flow.sums().U[Cons::rhoE];
}

TEST(Afterburn, EnergyOfAClosedBoxIsTheBookedOne) {
  for (const char* rest : {"end = \"40 us\"\n", "kind = \"miller\"\nrate = 2e5\n"}) {
    Flow flow(closed_box + rest);
    EXPECT_LT(unbooked(flow, 40), 1e-13);
    EXPECT_GT(flow.m.setup.afterburn->share, 0.1);
    // all products are still there, but for traces, and each kilogramme has released the same
    EXPECT_NEAR(flow.books.booked(flow.m).afterburn,
                flow.m.setup.afterburn->share * flow.m.setup.afterburn->energy * flow.sums().U[Cons::arho1],
                1e-7 * flow.books.booked(flow.m).afterburn);
  }
}

TEST(Afterburn, ProductsAtRestAreHeated) {
  const std::string full = closed_box.substr(0, closed_box.find("[[fluid.region]]")) + R"(
[[fluid.region]]
shape = {kind = "everywhere"}
material = "TNT"
density = 80
pressure = 1e8
[fluid.afterburn]
material = "TNT"
energy = 2e6
begin = 10e-6
end = 30e-6
)";
  Flow flow(full);
  flow.steps(5, 1e-6);
  EXPECT_EQ(flow.books.booked(flow.m).afterburn, 0);
  flow.steps(60, 1e-6);
  EXPECT_EQ(flow.m.setup.afterburn->share, 1);
  EXPECT_NEAR(flow.books.p_max(flow.m), 1e8 + 0.30 * 80 * 2e6, 1e-4);  // p = p0 + omega rho q
  EXPECT_LT(flow.sweep.active().size(), 1u);                           // and are at rest again
}

TEST(Afterburn, WhatIsLeftAtTheStartBurnsAtOnePace) {
  Afterburn a;
  a.begin = 1e-3, a.end = 5e-3, a.share = 0.3;
  EXPECT_DOUBLE_EQ(a.share_at(0.5e-3, 2e-3, 0), 0.3 + 0.7 / 4);  // it begins in this step
  EXPECT_DOUBLE_EQ(a.share_at(3e-3, 4e-3, 0), 0.3 + 0.7 / 2);    // a run that starts late
  EXPECT_EQ(a.share_at(4e-3, 5e-3, 0), 1);
}

TEST(Afterburn, MillersShareFollowsItsRate) {
  Afterburn a;
  a.kind = Afterburn::Kind::miller, a.rate = 2e4, a.least_pressure = 1e5;
  const double p = 3e9, t = 30e-6;
  for (double m : {0.5, 1.0, 2.0}) {
    a.m = m;
    double share = 0;
    for (int i = 0; i < 30000; ++i) {  // midpoint rule
      const auto rate = [&](double s) { return a.rate * std::pow(1 - s, m) * std::pow(p / 1e11, 1.0 / 6); };
      share += 1e-9 * rate(share + 0.5e-9 * rate(share));
    }
    EXPECT_NEAR(a.share_at(0, t, p), share, 1e-9);
  }
  a.m = 0.5;
  EXPECT_EQ(a.share_at(0, 1.0, p), 1);  // ends
  EXPECT_EQ(a.share_at(0, t, 0.9e5), 0);
  a.begin = 20e-6;
  EXPECT_EQ(a.share_at(0, 20e-6, p), 0);
}

TEST(Afterburn, HeatOfCombustionOfTnt) {
  EXPECT_NEAR(*heat_of_combustion("TNT"), 14.5e6, 0.05e6);  // 14.5 MJ/kg, water as vapour [Ornellas 1982]
  EXPECT_FALSE(heat_of_combustion("C-4"));
}

TEST(Afterburn, SameBitsOnThreadsAndWithBlocksAtRest) {
  expect_equal_on_threads(closed_box + "kind = \"miller\"\nrate = 2e5\n", 20);
  expect_rest_is_skipped(closed_box + "end = \"40 us\"\n", 8);
}

}  // namespace
}  // namespace bw::cfd
