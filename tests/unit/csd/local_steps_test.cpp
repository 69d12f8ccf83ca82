// SPDX-License-Identifier: Apache-2.0
// Local time steps against steps that all elements share: momenta, energy, motion, and how much is left out.
#include <gtest/gtest.h>

#include "csd/cracks.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

/// A bar whose cells grow tenfold and more along x.
Mesh graded_bar() {
  Box b;
  b.lower = {0, 0, 0}, b.upper = {0.1, 0.02, 0.02}, b.cells = {24, 4, 4}, b.grading = {40, 1, 1};
  Mesh mesh = b.make();
  renumber_for_locality(mesh);  // blocks of neighbours
  return mesh;
}
Vec3 tumbling(const Vec3& X) { return cross({10, 20, 30}, X - Vec3{0.02, 0, 0}) + Vec3{0, 0, 100 * X.x * X.x * 30}; }

struct Motion {
  Vec3 momentum, spin;  // kg m/s, kg m^2/s
};
Motion motion(const State& s) {
  Motion sum;
  for (int i = 0; i < int(s.x.size()); ++i) {
    const NodeId n(i);
    sum.momentum += s.m[n] * s.v[n], sum.spin += cross(s.x[n], s.m[n] * s.v[n]);
  }
  return sum;
}
struct Totals {
  int steps = 0;
  double evaluations = 0, worst_residual = 0;  // per element; J
  int top = 0;
};
/// To the time t, by levels that change as the bar deforms.
Totals run(Model& m, int levels, double t) {
  m.state.local.most = levels;
  Totals r;
  while (m.state.t < t) {
    const double dt = std::fmin(0.9 * stable_step(m), t - m.state.t);
    r.evaluations += m.state.local.evaluations();
    step(m, dt);
    ++r.steps, r.top = std::max(r.top, m.state.local.top());
    r.worst_residual = std::fmax(r.worst_residual, std::fabs(energy_row(m.physics, m.state).residual));
  }
  return r;
}

TEST(LocalSteps, FreeBarKeepsMomentaAndEnergyAndMovesAsWithOneStep) {
  Model one = make_model(graded_bar(), copper_elastic(), tumbling),
        local = make_model(graded_bar(), copper_elastic(), tumbling);
  const Motion before = motion(local.state);
  const double energy = local.physics.energy.initial;
  const Totals a = run(one, 0, 2e-4), b = run(local, 3, 2e-4);
  EXPECT_EQ(b.top, 3);
  EXPECT_LT(b.steps, 0.2 * a.steps);
  EXPECT_LT(b.evaluations, 0.7 * a.evaluations);
  const Motion after = motion(local.state);
  EXPECT_LT(norm(after.momentum - before.momentum), 1e-12 * norm(before.momentum));
  EXPECT_LT(norm(after.spin - before.spin), 1e-11 * norm(before.spin));
  EXPECT_LT(b.worst_residual, 0.01 * energy);
  double travel = 0, apart = 0;
  for (int i = 0; i < one.mesh.node_count(); ++i) {
    travel = std::fmax(travel, norm(one.state.x[NodeId(i)] - one.mesh.X[NodeId(i)]));
    apart = std::fmax(apart, norm(one.state.x[NodeId(i)] - local.state.x[NodeId(i)]));
  }
  EXPECT_LT(apart, 5e-3 * travel);
}

TEST(LocalSteps, UniformMeshTakesOneStep) {
  const auto make = [] { return make_model(box({0, 0, 0}, {0.1, 0.05, 0.05}, {8, 4, 4}), copper_elastic(), tumbling); };
  Model one = make(), local = make();
  run(one, 0, 2e-5);
  EXPECT_EQ(run(local, 3, 2e-5).top, 0);
  for (int i = 0; i < one.mesh.node_count(); ++i)
    ASSERT_NEAR(norm(one.state.x[NodeId(i)] - local.state.x[NodeId(i)]), 0, 1e-9);
}

TEST(LocalSteps, ConditionsAndLoadsAreBookedByTheirNodesSteps) {
  Fixed fixed;
  fixed.nodes = "x_upper";
  RigidWall wall;
  wall.normal = {1, 0, 0};
  Pressure pressure;
  pressure.table = {{0, 1}, {2e8, 2e8}}, pressure.faces = {"z_upper"};
  const auto approaching = [](const Vec3& X) { return Vec3{-60 * (1 - X.x / 0.1), 0, 0}; };
  Model m = make_model(graded_bar(), copper_j2(), approaching, {fixed, wall}, {pressure});
  const Totals r = run(m, 3, 1e-4);
  EXPECT_EQ(r.top, 3);
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_GT(e.plastic, 1);
  EXPECT_GT(m.physics.energy.external, 1);
  EXPECT_LT(r.worst_residual, 0.01 * (e.kinetic + e.elastic + e.plastic));
  for (int i = 0; i < m.mesh.node_count(); ++i) ASSERT_GE(m.state.x[NodeId(i)].x, -1e-12);
  for (const NodeId n : m.mesh.node_sets.at("x_upper")) EXPECT_LT(norm(m.state.x[n] - m.mesh.X[n]), 1e-15);
}

}  // namespace
}  // namespace bw::csd
