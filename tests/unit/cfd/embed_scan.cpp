// SPDX-License-Identifier: Apache-2.0
// T8: degenerate surfaces on the lattice.
#include <gtest/gtest.h>

#include "cfd/embed/predicates.h"
#include "cfd/embed/scan.h"
#include "common/math/random.h"
#include "embed_surfaces.h"

namespace bw::cfd {
namespace {

using namespace test;

Lattice lattice(int n, double length = 1) {
  const double h = length / n;
  return {{}, {h, h, h}, {n, n, n}};
}

std::vector<bool> mask(const WetSurface& s, const Lattice& g, bool* watertight = nullptr) {
  CutMap map;
  const bool closed = scan(s, g, map);
  if (watertight) *watertight = closed;
  std::vector<bool> covered;
  for (int k = 0; k < g.n[2]; ++k)
    for (int j = 0; j < g.n[1]; ++j)
      for (int i = 0; i < g.n[0]; ++i) {
        const Index3 c{i, j, k};
        covered.push_back(map.blocked(c));
        // a closed body: covered and open cells are always parted by a cut link
        for (int d = 0; d < 3; ++d) {
          Index3 u = c;
          if (++u[d] < g.n[d] && closed && map.blocked(c) != map.blocked(u)) {
            EXPECT_NE(map.link(c, d), nullptr);
          }
        }
      }
  return covered;
}
int64_t count(const std::vector<bool>& m) { return std::count(m.begin(), m.end(), true); }

TEST(EmbedPredicates, ExactOnDegenerateInput) {
  EXPECT_EQ(side_of_line(0, 0, 1, 1, 0.5, 0.5), -1);
  EXPECT_EQ(side_of_line(1, 1, 0, 0, 0.5, 0.5), 1);
  EXPECT_EQ(side_of_line(0, 0, 1, 0, 0.5, 0), 1);
  EXPECT_EQ(side_of_line(0.3, 0.3, 0.3, 0.3, 0.3, 0.3), 0);
  const Vec3 a{0, 0, 0.1}, b{1, 0, 0.1}, c{0, 1, 0.1};
  EXPECT_EQ(side_of_triangle(a, b, c, {0.2, 0.2, 0.1}), 1);
  EXPECT_EQ(side_of_triangle(a, c, b, {0.2, 0.2, 0.1}), -1);
  // every rounding of a point on an oblique plane is on one side for one order of the corners and on the other for the
  // other
  for (uint64_t i = 0; i < 2000; ++i) {
    auto r = [&](int j) { return uniform01(1, i, uint64_t(j)); };
    const Vec3 p{r(0), r(1), r(2)}, q{r(3), r(4), r(5)}, s{r(6), r(7), r(8)};
    const double u = r(9), v = r(10);
    const Vec3 x = p + u * (q - p) + v * (s - p);
    EXPECT_EQ(side_of_triangle(p, q, s, x), -side_of_triangle(q, p, s, x));
    EXPECT_EQ(side_of_triangle(p, q, s, x), side_of_triangle(q, s, p, x));
  }
}

TEST(EmbedScan, BoxOnCellFacesAndOnCentres) {
  const Lattice g = lattice(8);
  EXPECT_EQ(count(mask(box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, 4), g)), 64);
  // corners, edges and faces on centres: half-open, so the same number whichever way the quads are split
  EXPECT_EQ(count(mask(box({0.1875, 0.1875, 0.1875}, {0.6875, 0.6875, 0.6875}, 4), g)), 64);
  EXPECT_EQ(count(mask(box({0.1875, 0.1875, 0.1875}, {0.6875, 0.6875, 0.6875}, 3), g)), 64);
  // larger than the lattice
  EXPECT_EQ(count(mask(box({-1, -1, -1}, {0.5, 2, 2}, 2), g)), 256);
}

TEST(EmbedScan, LinksKnowDistanceFaceAndNormal) {
  const Lattice g = lattice(8);
  WetSurface s = box({0.3, -1, -1}, {0.6, 2, 2});
  set_velocity(s, {7, 0, 0});
  CutMap map;
  EXPECT_TRUE(scan(s, g, map));
  EXPECT_EQ(map.link_count(), 128u);
  const CutLink* l = map.link({1, 3, 3}, 0);
  ASSERT_NE(l, nullptr);
  EXPECT_NEAR(l->below.s, 0.9, 1e-13);
  EXPECT_NEAR(l->above.s, 0.1, 1e-13);
  EXPECT_EQ(l->below.n, (Vec3{-1, 0, 0}));
  EXPECT_EQ(l->below.v, (Vec3{7, 0, 0}));
  EXPECT_EQ(l->below.face, 0);
  // both walls of a body thinner than a cell, each for its own side
  s = box({0.40, -1, -1}, {0.42, 2, 2});
  scan(s, g, map);
  l = map.link({2, 3, 3}, 0);
  ASSERT_NE(l, nullptr);
  EXPECT_NEAR(l->below.s, (0.40 - 0.3125) * 8, 1e-12);
  EXPECT_NEAR(l->above.s, (0.4375 - 0.42) * 8, 1e-12);
  EXPECT_EQ(l->above.n, (Vec3{1, 0, 0}));
  EXPECT_EQ(count(mask(s, g)), 0);
}

TEST(EmbedScan, SphereVolumeAndUnits) {
  const double exact = 4.0 / 3 * M_PI * std::pow(0.31, 3);
  const auto base = mask(sphere({0.503, 0.498, 0.511}, 0.31, 24), lattice(40));
  EXPECT_NEAR(double(count(base)) / 64000, exact, 0.01 * exact);
  for (const double unit : {1e-3, 1e3}) {
    WetSurface s = sphere({0.503, 0.498, 0.511}, 0.31, 24);
    for (Vec3& x : s.x) x = unit * x;
    EXPECT_EQ(mask(s, lattice(40, unit)), base);
  }
}

TEST(EmbedScan, TiltedShiftedAndTouchingIsWatertight) {
  for (int trial = 0; trial < 40; ++trial) {
    // nodes rounded to the lattice of half cells: lines run through vertices and along edges and faces
    WetSurface s = sphere({0.5, 0.5, 0.5}, 0.3 + 0.004 * trial, 3 + trial % 4);
    rotate(s, {0, 0, 1}, 0.1 * trial, {0.5, 0.5, 0.5});
    for (Vec3& x : s.x)
      for (int d = 0; d < 3; ++d) x[d] = std::round(x[d] * 32) / 32;
    bool watertight = false;
    mask(s, lattice(16), &watertight);
    EXPECT_TRUE(watertight);
  }
}

TEST(EmbedScan, CoincidentAndFlatFacesChangeNothing) {
  const Lattice g = lattice(16);
  const WetSurface whole = sphere({0.5, 0.5, 0.5}, 0.33, 6);
  const auto base = mask(whole, g);
  WetSurface s = whole;  // a fresh crack: two opposite faces at the same place, started at different nodes
  s.x.push_back({0.3, 0.41, 0.4});
  s.x.push_back({0.7, 0.42, 0.41});
  s.x.push_back({0.68, 0.6, 0.7});
  s.x.push_back({0.31, 0.61, 0.6});
  const int32_t a = int32_t(whole.x.size());
  s.quads.push_back({a, a + 1, a + 2, a + 3});
  s.quads.push_back({a, a + 3, a + 2, a + 1});
  s.quads.push_back({a, a, a, a});          // a point
  s.quads.push_back({a, a + 1, a, a + 1});  // a line
  s.quads.push_back({a, a + 1, a + 1, a});
  finish(s);
  EXPECT_EQ(mask(s, g), base);
  // every face twice, turned: nothing is left inside
  WetSurface twice = whole;
  for (auto q : whole.quads) twice.quads.push_back({q[1], q[0], q[3], q[2]});
  finish(twice);
  EXPECT_EQ(count(mask(twice, g)), 0);
}

TEST(EmbedScan, CrackedPlateStaysShut) {
  // a slab cut into two fragments along an oblique warped face: no cell of the crack opens, at any place of the lattice
  for (int trial = 0; trial < 20; ++trial) {
    const double y = 0.2 + 0.011 * trial;
    WetSurface s;
    s.x = {{0.1, 0.1, 0.1}, {0.9, 0.1, 0.1}, {0.9, y, 0.1},        {0.1, y + 0.1, 0.1},
           {0.1, 0.1, 0.9}, {0.9, 0.1, 0.9}, {0.9, y + 0.15, 0.9}, {0.1, y, 0.9},
           {0.1, 0.9, 0.1}, {0.9, 0.9, 0.1}, {0.1, 0.9, 0.9},      {0.9, 0.9, 0.9}};
    s.quads = {{0, 3, 2, 1}, {4, 5, 6, 7},   {0, 1, 5, 4},   {1, 2, 6, 5},  {0, 4, 7, 3},  {3, 7, 6, 2},
               {3, 8, 9, 2}, {7, 6, 11, 10}, {8, 10, 11, 9}, {2, 9, 11, 6}, {3, 7, 10, 8}, {7, 3, 2, 6}};
    finish(s);
    WetSurface whole = s;
    whole.quads.erase(whole.quads.begin() + 11);
    whole.quads.erase(whole.quads.begin() + 5);
    finish(whole);
    EXPECT_EQ(mask(s, lattice(20)), mask(whole, lattice(20)));
  }
}

TEST(EmbedScan, SelfIntersectionCountsOnce) {
  const Lattice g = lattice(20);
  const auto a = mask(sphere({0.4, 0.5, 0.5}, 0.25, 8), g), b = mask(sphere({0.6, 0.5, 0.5}, 0.25, 8), g);
  WetSurface s = sphere({0.4, 0.5, 0.5}, 0.25, 8);
  append(s, sphere({0.6, 0.5, 0.5}, 0.25, 8));
  const auto both = mask(s, g);
  for (size_t i = 0; i < both.size(); ++i) EXPECT_EQ(both[i], a[i] || b[i]);
}

TEST(EmbedScan, HairShiftChangesOnlyTouchedCells) {
  const Lattice g = lattice(16);
  const auto base = mask(box({0.21875, 0.25, 0.25}, {0.78125, 0.75, 0.75}, 8), g);
  for (const double shift : {1e-12, -1e-12}) {
    const auto moved = mask(box({0.21875 + shift, 0.25 + shift, 0.25}, {0.78125 + shift, 0.75 + shift, 0.75}, 8), g);
    size_t i = 0;
    for (int c = 0; c < 4096; ++c, ++i) {
      const int x = c % 16;
      if (x != 3 && x != 12) {  // the x faces run through centres 3 and 12
        EXPECT_EQ(base[i], moved[i]);
      }
    }
  }
}

TEST(EmbedScan, OneSidedSurfaceCoversWhatIsBehind) {
  WetSurface s = plate({0.5, 0.5, 0.5}, {0, 3, 0}, {0, 0, 3});  // normal +x
  s.flags.assign(1, 0);
  bool watertight = true;
  const auto m = mask(s, lattice(8), &watertight);
  EXPECT_FALSE(watertight);
  for (int c = 0; c < 512; ++c) EXPECT_EQ(m[size_t(c)], c % 8 < 4);
}

}  // namespace
}  // namespace bw::cfd
