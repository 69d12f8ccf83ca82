// SPDX-License-Identifier: Apache-2.0
// Openings narrower than a cell: their area, a flow that moves with them, and what closes them.
#include <gtest/gtest.h>

#include "cfd/embed/apertures.h"
#include "embed_block.h"

namespace bw::cfd {
namespace {

using namespace test;

/// Two thin plates x = `place` that leave lower < y < lower + width open, in a box of 8 x 8 x 1 cells of 1.
WetSurface slit(double place, double lower, double width) {
  WetSurface s;
  const double edge[2][2] = {{-3, lower}, {lower + width, 11}};
  for (const auto& e : edge) {
    const int32_t first = int32_t(s.x.size());
    for (const Vec3& x : {Vec3{place, e[0], -1}, Vec3{place, e[1], -1}, Vec3{place, e[1], 2}, Vec3{place, e[0], 2}})
      s.x.push_back(x);
    s.quads.push_back({first, first + 1, first + 2, first + 3});
    s.flags.push_back(coupling::face_thin);
  }
  s.v.assign(s.x.size(), {});
  return s;
}

double open_width(const CutMap& map) {
  std::array<double, 8> open{};  // of the rows of the grid
  for (int j = 0; j < 8; ++j) {
    open[size_t(j)] = 1;
    for (int i = 0; i < 7; ++i)
      if (map.is_cut({i, j, 0}, 0)) open[size_t(j)] = 0;
  }
  for (const Aperture& a : map.apertures())
    if (a.d == 0) open[size_t(a.cell[1])] = a.open;
  double sum = 0;
  for (const double o : open) sum += o;
  return sum;
}

TEST(EmbedApertures, OpenAreaIsTheSlitsWhereverTheGridLies) {
  const Lattice g{{}, {1, 1, 1}, {8, 8, 1}};
  CutMap map;
  for (const double place : {4.0, 4.5, 4.2, 3.999999999999})  // on cell faces, on centres, between
    for (const double lower : {3.0, 3.1, 3.5, 3.6, 3.9})
      for (const double width : {1e-3, 0.05, 0.3, 0.5, 1.0, 1.7}) {
        const WetSurface s = slit(place, lower, width);
        scan(s, g, map);
        find_apertures(s, Slits::area, map);
        EXPECT_NEAR(open_width(map), width, 1e-12) << place << " " << lower << " " << width;
        scan(s, g, map);
        find_apertures(s, Slits::sealed, map);
        EXPECT_LE(open_width(map), std::floor(width)) << place << " " << lower << " " << width;
      }
  scan(slit(4.2, 3.4, 0), g, map);
  find_apertures(slit(4.2, 3.4, 0), Slits::area, map);
  EXPECT_TRUE(map.apertures().empty());  // edges that touch leave nothing open
}

TEST(EmbedApertures, BothLayersOfAThinBodyBlockOnce) {
  const Lattice g{{}, {1, 1, 1}, {8, 8, 1}};
  WetSurface s = box({4.1, -3, -1}, {4.3, 3.3, 2});
  append(s, box({4.1, 3.7, -1}, {4.3, 11, 2}));
  CutMap map;
  scan(s, g, map);
  find_apertures(s, Slits::area, map);
  EXPECT_NEAR(open_width(map), 0.4, 1e-12);
}

TEST(EmbedApertures, AFlowThatMovesWithASlitIsUniform) {  // F13 (a)
  using Block = OneBlock<TwoGases>;
  Block b({{}, {0.05, 0.05, 1}, {24, 20, 1}}, {}, GhostRule::copy);
  const Vec3 u{100, 50, 0};
  b.paint([&](const Vec3&) { return gas(1.225, u, 101325); });
  WetSurface s = slit(8.2, 8.1, 0.4);
  for (Vec3& x : s.x) x = {0.05 * x.x, 0.05 * x.y, x.z};
  set_velocity(s, u);
  b.place(s);
  int64_t narrow = 0;
  for (int step = 0; step < 100; ++step) {
    find_apertures(b.surface, Slits::area, b.map);
    narrow += int64_t(b.map.apertures().size());
    b.cuts.gather(b.map, b.rules, {});
    const double dt = 0.5 / b.largest_rate();
    b.advance(dt);
    b.move(dt);
  }
  EXPECT_GT(narrow, 100);
  b.for_cells([&](int k, int j, int i) {
    const auto w = b.get(k, j, i);
    EXPECT_NEAR(w[1] / 1.225, 1, 1e-12);
    EXPECT_NEAR(w[Prim::p] / 101325, 1, 1e-12);
    EXPECT_NEAR(w[Prim::v] / 100, 1, 1e-12);
  });
}

TEST(EmbedOrifice, ChokedAndSlowJets) {
  // choked, at rest before: p* and flow of a perfect gas, narrowed by 0.84 to 0.84 - 0.23 r^2
  const double p0 = 1e7, rho0 = 116, K = 1.4 * p0;
  const Jet vacuum = jet(rho0, p0, K, 2.5, 0, 1e-3);
  EXPECT_NEAR(vacuum.pressure / p0, 0.52828, 1e-4);
  EXPECT_NEAR(vacuum.mass, 0.84 * 0.57870 * rho0 * std::sqrt(K / rho0), 1e-3 * vacuum.mass);
  // a small difference: Bernoulli, pi/(pi + 2)
  const Jet slow = jet(rho0, p0, K, 2.5, 0, 0.9999 * p0);
  EXPECT_NEAR(slow.mass, 0.611 * std::sqrt(2 * rho0 * 1e-4 * p0), 0.003 * slow.mass);
  EXPECT_EQ(jet(rho0, p0, K, 2.5, 0, p0).mass, 0);
}

}  // namespace
}  // namespace bw::cfd
