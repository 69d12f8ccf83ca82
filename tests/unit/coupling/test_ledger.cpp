// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/ledger_report.h"

namespace bw::coupling {
namespace {

/// A warped patch of quads and triangles over the unit square.
WetSurface patch(int n) {
  WetSurface s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = double(i) / n, y = double(j) / n;
      s.x.push_back({x, y + 0.1 * x * x, 0.3 * std::sin(3 * x) * y});
      s.v.push_back({1 + x, y, 2 - x * y});
      s.node_id.push_back(int64_t(s.node_id.size()));
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      if ((i + j) % 3 == 0) {
        s.quads.push_back({a, b, c, c});
        s.quads.push_back({a, c, d, d});
      } else {
        s.quads.push_back({a, b, c, d});
      }
    }
  s.node_parent.assign(s.x.size(), -1);
  for (size_t f = 0; f < s.quads.size(); ++f) s.face_id.push_back(int64_t(f));
  s.body.assign(s.quads.size(), 0);
  s.flags.assign(s.quads.size(), 0);
  return s;
}

Loads loads_for(const WetSurface& s, double t0, double t1) {
  Loads loads;
  loads.t1 = t1;
  for (size_t f = 0; f < s.quads.size(); ++f) loads.p.push_back(1e5 * (1 + std::sin(double(f))));
  loads.totals = wall_totals(s, loads, s.v, {.t0 = t0});
  return loads;
}

TEST(Loads, TriangleGetsThirdsQuadGetsQuarters) {
  WetSurface s;
  s.x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.quads = {{0, 1, 2, 2}};
  Loads loads;
  loads.p = {3e5};
  auto f = nodal_loads(s, loads, 1e5);  // 2e5 Pa on half a square metre, against the normal +z
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(f[size_t(i)].z, -1e5 / 3);
  EXPECT_EQ(f[3].z, 0);
  s.quads = {{0, 1, 2, 3}};
  f = nodal_loads(s, loads, 1e5);
  for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(f[size_t(i)].z, -5e4);
  loads.traction = {{100, 0, 0}};
  EXPECT_DOUBLE_EQ(nodal_loads(s, loads, 1e5)[2].x, 25);
}

TEST(Loads, ReferencePressureLoadsNothing) {
  const WetSurface s = patch(5);
  Loads loads;
  loads.p.assign(s.quads.size(), 101325);
  for (const Vec3& f : nodal_loads(s, loads, 101325)) EXPECT_EQ(norm(f), 0);
}

TEST(Ledger, BothSidesBalance) {
  WetSurface s = patch(7);
  const double p_ref = 1e5, t1 = 1 + 3e-6, dt = t1 - 1;
  Ledger ledger(p_ref);
  const Loads loads = loads_for(s, 1, t1);
  ledger.begin(s), ledger.open({.index = 0, .t0 = 1, .t1_max = 2}, loads);
  const auto force = nodal_loads(s, loads, p_ref);
  auto x = s.x;
  for (int step = 0; step < 7; ++step) {
    const auto before = x;
    for (size_t i = 0; i < x.size(); ++i) x[i] += (dt / 7) * s.v[i];
    ledger.add(substep_totals(force, s.x, before, x, dt / 7));
  }
  EXPECT_FALSE(ledger.close(x));
  const LedgerRow& row = ledger.row();
  EXPECT_EQ(row.solid.substeps, 7);
  EXPECT_LT(norm(row.moment_defect), 1e-12 * row.impulse_scale);
  EXPECT_NEAR(row.work_fluid, row.solid.work, 1e-9 * std::abs(row.solid.work));  // walls and nodes moved alike
  EXPECT_NEAR(row.volume_gap, 0, 1e-16);
  EXPECT_NEAR(
      row.impulse_scale,
      [&] {
        double sum = 0;
        for (size_t f = 0; f < s.quads.size(); ++f) sum += loads.p[f] * norm(area_vector(s.x, s.quads[f])) * dt;
        return sum;
      }(),
      1e-12 * row.impulse_scale);
  EXPECT_LT(norm(ledger.sums().impulse_fluid - row.solid.impulse), 1e-12 * row.impulse_scale);
  EXPECT_LT(norm(ledger.sums().moment_fluid - row.solid.moment), 1e-12 * row.moment_scale);
  EXPECT_TRUE(report(ledger, 0).lost.empty());
}

TEST(Ledger, TheReportNamesWhatIsLost) {
  const WetSurface s = patch(4);
  const double dt = 1e-6;
  Ledger ledger(0);
  Loads loads = loads_for(s, 0, dt);
  loads.totals.moment.z *= 1 + 1e-9;
  ledger.begin(s), ledger.open({.index = 0, .t0 = 0, .t1_max = 1}, loads);
  auto x = s.x;
  for (size_t i = 0; i < x.size(); ++i) x[i] += (1.02 * dt) * s.v[i];
  ledger.add(substep_totals(nodal_loads(s, loads, 0), s.x, s.x, x, dt));
  EXPECT_FALSE(ledger.close(x));
  const LedgerReport books = report(ledger, 0);
  ASSERT_EQ(books.lost.size(), 2u);
  EXPECT_EQ(books.lost[0].find("moment"), 0u);
  EXPECT_EQ(books.lost[1].find("work"), 0u);
  EXPECT_EQ(report(ledger, 3 * std::abs(ledger.row().work_solid_sum)).lost.size(), 1u);  // 0.7 % of the kinetic energy
}

TEST(Ledger, LostImpulseIsFound) {
  const WetSurface s = patch(4);
  const double dt = 1e-6;
  Ledger ledger(0);
  const Loads loads = loads_for(s, 0, dt);
  ledger.begin(s), ledger.open({.index = 3, .t0 = 0, .t1_max = 1}, loads);
  ledger.add(substep_totals(nodal_loads(s, loads, 0), s.x, s.x, s.x, dt * (1 + 1e-11)));
  const auto text = ledger.close();
  ASSERT_TRUE(text);
  EXPECT_NE(text->find("in window 3"), std::string::npos);
}

TEST(Ledger, GapBirthsAndDeaths) {
  WetSurface s = patch(4);
  const double dt = 1e-6;
  Ledger ledger(0);
  const Loads loads = loads_for(s, 0, dt);
  ledger.begin(s), ledger.open({.index = 0, .t0 = 0, .t1_max = 1}, loads);
  EXPECT_EQ(ledger.row().born, 0);
  // the solid stays: the wall went ahead by v dt, the gap is minus the swept volume
  ledger.add(substep_totals(nodal_loads(s, loads, 0), s.x, s.x, s.x, dt));
  EXPECT_FALSE(ledger.close(s.x));
  EXPECT_NEAR(ledger.row().volume_gap, -loads.totals.swept, 1e-10 * std::abs(loads.totals.swept));
  s.face_id[0] = 1000, s.face_id[1] = 1001;
  s.topo_version = 1;
  ledger.begin(s), ledger.open({.index = 1, .t0 = dt, .t1_max = 1}, loads_for(s, dt, 2 * dt));
  EXPECT_EQ(ledger.row().born, 2);
  EXPECT_EQ(ledger.row().dead, 2);
}

}  // namespace
}  // namespace bw::coupling
