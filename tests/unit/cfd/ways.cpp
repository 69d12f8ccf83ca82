// SPDX-License-Identifier: Apache-2.0
// Programmed burn from lines and planes, and around corners.
#include <cmath>

#include "cfd/source/paths.h"
#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

TEST(Light, NearestOnLinesAndDiscs) {
  const LineLight line{{0, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(norm(Vec3{1, 3, 0} - line.nearest({1, 3, 0})), 3);
  EXPECT_EQ(norm(Vec3{5, 4, 0} - line.nearest({5, 4, 0})), 5);
  const DiscLight disc{{0, 0, 1}, {0, 0, 1}, 2};
  EXPECT_EQ(norm(Vec3{1, 1, 4} - disc.nearest({1, 1, 4})), 3);
  EXPECT_NEAR(norm(Vec3{5, 0, 5} - disc.nearest({5, 0, 5})), 5, 1e-12);
  Burn burn;
  burn.D = 1, burn.h = burn.margin = 0.1, burn.lines = {line};
  EXPECT_EQ(burn.phase({0, 4, 0}, {1, 5, 1}, 0, 2), Burn::Phase::before);
  EXPECT_EQ(burn.phase({0, 4, 0}, {1, 5, 1}, 20, 21), Burn::Phase::after);
}

/// An L of n x n cells of 1/n, without its quarter x > 1/2, y > 1/2; a point in the end of one arm.
ExplosiveCells corner_of(int n, bool whole = false) {
  const double h = 1.0 / n;
  ExplosiveCells c{{0.5 * h, 0.5 * h, 0}, {h, h, 1}, {n, n, 1}, std::vector<uint8_t>(size_t(n * n), 1)};
  for (int j = 0; j < n && !whole; ++j)
    for (int i = 0; i < n; ++i) c.inside[size_t(j * n + i)] = i < n / 2 || j < n / 2;
  return c;
}

TEST(Ways, AroundACornerAsAString) {
  const Vec3 point{0.95, 0.2, 0}, corner{0.5, 0.5, 0};
  Burn burn;
  burn.points = {point};
  for (const int n : {40, 80, 160}) {
    int64_t unreached = 0;
    const WayTable table = find_ways(burn, corner_of(n), unreached);
    ASSERT_FALSE(table.empty());
    EXPECT_EQ(unreached, 0);
    double worst = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (i >= n / 2 && j >= n / 2) continue;
        const Vec3 x{(i + 0.5) / n, (j + 0.5) / n, 0};
        // seen from the point, what lies beyond the corner is above the line through both
        const bool seen = x.x > 0.5 || (x.y - point.y) <= (corner.y - point.y) / (corner.x - point.x) * (x.x - point.x);
        const double exact = seen ? norm(x - point) : norm(corner - point) + norm(x - corner);
        const double way = norm(x - point) + table.more(x);
        EXPECT_GT(way, exact - 1e-12 - 1.0 / n);
        if (seen && norm(x - corner) > 3.0 / n && std::abs(way - norm(x - point)) > 0)
          continue;  // a step of the surface
        worst = std::max(worst, std::abs(way - exact));
      }
    EXPECT_LT(worst, 1.5 / n) << n;  // the corner is known to a cell
  }
}

TEST(Ways, StraightWhereNothingIsInTheWay) {
  Burn burn;
  burn.points = {{0.95, 0.2, 0}};
  int64_t unreached = 0;
  EXPECT_TRUE(find_ways(burn, corner_of(40, true), unreached).empty());
}

TEST(Ways, PartsThatAreNotJoinedAreCounted) {
  Burn burn;
  burn.points = {{0.95, 0.2, 0}};
  ExplosiveCells cells = corner_of(40);
  for (int i = 0; i < 40; ++i) cells.inside[size_t(30 * 40 + i)] = 0;  // a gap across the far arm
  int64_t unreached = 0;
  find_ways(burn, cells, unreached);
  EXPECT_EQ(unreached, 9 * 20);
}

const std::string bend = grid("[80, 80, 1]", "[0.1, 0.1, 0.001]") + air_and_tnt + R"([[fluid.region]]
shape = {kind = "box", lower = [0.01, 0.01, -1], upper = [0.09, 0.03, 1]}
material = "TNT"
unburnt = true
pressure = 101325
[[fluid.region]]
shape = {kind = "box", lower = [0.01, 0.01, -1], upper = [0.03, 0.09, 1]}
material = "TNT"
unburnt = true
pressure = 101325
[[fluid.burn]]
material = "TNT"
)";

TEST(Ways, ABentChargeIsLitAroundItsCorner) {
  Flow around(bend + "points = [[0.085, 0.02, 0]]\n"),
      straight(bend + "points = [[0.085, 0.02, 0]]\npath = \"straight\"\n");
  ASSERT_FALSE(around.m.setup.burn->ways.empty());
  EXPECT_TRUE(straight.m.setup.burn->ways.empty());
  const double middle = 0.0005;
  const Vec3 end{0.02, 0.085, middle}, point{0.085, 0.02, middle}, corner{0.03, 0.03, middle};
  EXPECT_NEAR(around.m.setup.burn->distance(end), norm(corner - point) + norm(end - corner), 1.5 * 0.1 / 80);
  EXPECT_NEAR(straight.m.setup.burn->distance(end), norm(end - point), 1e-15);
}

TEST(Ways, ABentChargeBurnsInSteadySteps) {
  Flow f(bend + "points = [[0.085, 0.02, 0]]\n");
  const double before = f.sums().U[Cons::arho1] + f.sums().U[Cons::arho2];
  f.steps(360);
  EXPECT_GT(f.m.state.t, 1.8e-5);                                                         // all of it has burnt
  EXPECT_NEAR(f.sums().U[Cons::arho1] + f.sums().U[Cons::arho2], before, 1e-7 * before);  // traces are taken away
}

TEST(Ways, LinesAndPlanesLightACharge) {
  Flow line(bend + "[[fluid.burn.line]]\nfrom = [0.02, 0.02, 0]\nto = [0.02, 0.085, 0]\n"),
      plane(bend + "[[fluid.burn.plane]]\npoint = [0.02, 0.02, 0]\nnormal = [0, 2, 0]\n");
  EXPECT_NEAR(line.m.setup.burn->distance({0.085, 0.02, 0.0005}), 0.065, 1e-12);
  EXPECT_NEAR(plane.m.setup.burn->distance({0.05, 0.025, 0.0005}), 0.005, 1e-12);
  EXPECT_THROW(Flow(bend + "[[fluid.burn.plane]]\npoint = [0.02, 0.5, 0]\nnormal = [0, 1, 0]\n"), InputError);
  EXPECT_THROW(Flow(bend + "[[fluid.burn.plane]]\npoint = [0.02, 0.02, 0]\nnormal = [0, 0, 1]\n"), InputError);
}

}  // namespace
}  // namespace bw::cfd
