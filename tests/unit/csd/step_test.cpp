// SPDX-License-Identifier: Apache-2.0
// Central differences on whole models: energy (S12), threads, the stable step of the assembled model, momenta.
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Eigenvalues>

#include "solid_scene.h"

namespace bw::csd {
namespace {

Vec3 momentum(const State& s) {
  Vec3 p;
  for (int n = 0; n < int(s.x.size()); ++n) p += s.m[NodeId(n)] * s.v[NodeId(n)];
  return p;
}
Vec3 angular_momentum(const State& s) {
  Vec3 L;
  for (int n = 0; n < int(s.x.size()); ++n) L += cross(s.x[NodeId(n)], s.m[NodeId(n)] * s.v[NodeId(n)]);
  return L;
}
/// A block that vibrates and turns.
Vec3 wild(const Vec3& X) { return {20 * X.y + 30 * std::sin(40 * X.z), -20 * X.x + 25 * X.z, 40 * X.x * X.y * 50 + 5}; }

TEST(S12, ElasticBlockKeepsEnergyAndMomenta) {
  Model m = make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4}, 0.15), copper_elastic(), wild);
  const Vec3 p0 = momentum(m.state), L0 = angular_momentum(m.state);
  const double dt = 0.3 * stable(m), E0 = m.physics.energy.initial;
  double largest = 0, mean_early = 0, mean_late = 0;
  const int steps = 10000;
  for (int n = 1; n <= steps; ++n) {
    step(m, dt);
    if (n % 10) continue;
    const double r = energy_row(m.physics, m.state).residual / E0;
    largest = std::fmax(largest, std::fabs(r));
    (n <= steps / 2 ? mean_early : mean_late) += r / (steps / 20);
  }
  EXPECT_LT(largest, 2e-3);                            // bounded, of order (omega dt)^2
  EXPECT_LT(std::fabs(mean_late - mean_early), 1e-4);  // no drift
  EXPECT_LT(norm(momentum(m.state) - p0), 1e-11 * norm(p0));
  EXPECT_LT(norm(angular_momentum(m.state) - L0), 1e-10 * norm(L0));
  RecordProperty("largest_residual", std::to_string(largest));
  RecordProperty("drift", std::to_string(mean_late - mean_early));
}

TEST(S12, ResidualFallsWithTheSquareOfTheStep) {
  double worst[2];
  for (int i = 0; i < 2; ++i) {
    Model m = make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {3, 3, 3}, 0.1), copper_elastic(), wild);
    const double dt = (i ? 0.05 : 0.1) * stable(m);
    worst[i] = 0;
    for (int n = 0; n < (i ? 2000 : 1000); ++n) {
      step(m, dt);
      worst[i] = std::fmax(worst[i], std::fabs(energy_row(m.physics, m.state).residual));
    }
  }
  EXPECT_NEAR(worst[0] / worst[1], 4, 0.4);
}

/// Work of all nodal forces by the mean force of each step against the kinetic energy in product form.
TEST(S12, WorkFormCloses) {
  Pressure pressure;
  pressure.table = {{0, 1}, {3e8, 3e8}}, pressure.faces = {"x_upper"};
  Fixed fixed;
  fixed.nodes = "x_lower";
  Model m = make_model(box({0, 0, 0}, {0.1, 0.05, 0.05}, {6, 3, 3}, 0.1), copper_j2(), {}, {fixed}, {pressure});
  const double dt = 0.5 * stable(m);
  double work = 0;
  const double start_product = kinetic_product(m.state, dt);
  for (int n = 0; n < 500; ++n) {
    const Field<Vec3, NodeId> f = m.state.f, x = m.state.x;
    step(m, dt);
    for (int i = 0; i < m.mesh.node_count(); ++i)
      work += dot(0.5 * (f[NodeId(i)] + m.state.f[NodeId(i)]), m.state.x[NodeId(i)] - x[NodeId(i)]);
  }
  const double gained = kinetic_product(m.state, dt) - start_product;
  EXPECT_GT(m.physics.energy.external, 1);
  EXPECT_NEAR(work, gained, 1e-12 * m.physics.energy.external);
}

TEST(S12, PlasticImpactWithAWall) {
  RigidWall wall;
  wall.normal = {0, 0, 1};
  Model m = make_model(box({0, 0, 0}, {0.01, 0.01, 0.03}, {4, 4, 12}), copper_j2(),
                       [](const Vec3&) {
                         return Vec3{0, 0, -200};
                       },
                       {wall});
  const double E0 = m.physics.energy.initial, p0 = momentum(m.state).z;
  double impulse = 0;
  for (int n = 0; n < 1500; ++n) {
    step(m, 0.9 * stable(m));
    impulse += std::get<RigidWall>(m.physics.conditions[0]).reaction.impulse.z;
    for (int i = 0; i < m.mesh.node_count(); ++i) ASSERT_GE(m.state.x[NodeId(i)].z, -1e-12);
  }
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_GT(e.plastic, 0.5 * E0);
  EXPECT_LT(std::fabs(e.residual), 0.01 * E0);
  EXPECT_NEAR(e.conditions, -E0 / 24, 1e-3 * E0);  // kinetic energy of the wall nodes, 1/(2 nz)
  EXPECT_NEAR(momentum(m.state).z - p0, impulse, 1e-11 * std::fabs(p0));
}

TEST(S12, PrescribedVelocityBringsItsWork) {
  PrescribedVelocity pull;
  pull.nodes = "x_upper", pull.value = {50, 0, 0};
  pull.factor = Table{{0, 10e-6}, {0, 1}};
  Roller hold;
  hold.nodes = "x_lower", hold.normal = {1, 0, 0};
  Model m = make_model(box({0, 0, 0}, {0.02, 0.01, 0.01}, {6, 3, 3}), copper_j2(), {}, {hold, pull});
  for (int n = 0; n < 400; ++n) step(m, 0.9 * stable(m));
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_GT(e.plastic, 0);
  EXPECT_NEAR(e.residual, 0, 0.005 * e.conditions);
}

TEST(S12, ViscosityIsBooked) {
  RigidWall wall;
  wall.normal = {1, 0, 0};
  Model m = make_model(box({0, 0, 0}, {0.1, 0.01, 0.01}, {40, 1, 1}), copper_elastic(),
                       [](const Vec3&) {
                         return Vec3{-20, 0, 0};
                       },
                       {wall}, {}, {}, {0.06, 1.5});
  for (int n = 0; n < 200; ++n) step(m, 0.9 * stable(m));
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_GT(e.viscosity, 1e-4 * m.physics.energy.initial);
  EXPECT_NEAR(e.residual, 0, 0.01 * m.physics.energy.initial);
}

TEST(Step, ThreadsDoNotChangeABit) {
  const int before = omp_get_max_threads();
  std::vector<Field<Vec3, NodeId>> x;
  for (int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    Mesh mesh = box({0, 0, 0}, {0.1, 0.1, 0.1}, {14, 13, 12}, 0.15);
    renumber_for_locality(mesh);
    Model m = make_model(std::move(mesh), copper_j2(), [](const Vec3& X) { return 5.0 * wild(X); }, {}, {},
                         {"self_adjoint", 0.5}, {0.06, 1.5});
    ASSERT_GT(m.physics.elements.blocks.colours.size(), 1u);
    for (int n = 0; n < 30; ++n) step(m, 0.9 * stable(m));
    x.push_back(m.state.x);
  }
  omp_set_num_threads(before);
  for (size_t i = 1; i < x.size(); ++i) EXPECT_EQ(0, memcmp(x[0].data(), x[i].data(), x[0].size() * sizeof(Vec3)));
}

/// A bar that is pushed at one end; the other half is not reached.
Model pushed(bool track, bool skip, const FilterCase& filter) {
  PrescribedVelocity push;
  push.nodes = "x_lower", push.value = {20, 0, 0};
  Mesh mesh = box({0, 0, 0}, {0.4, 0.01, 0.01}, {160, 4, 4}, 0.1);
  renumber_for_locality(mesh);
  Model m = make_model(std::move(mesh), copper_j2(), {}, {push}, {}, filter);
  m.physics.resting.skip = skip;
  if (track) m.physics.resting.start(m.physics.elements.blocks.block_count());
  first_forces(m);
  for (int n = 0; n < 80; ++n) step(m, 0.9 * stable(m));
  return m;
}

TEST(Step, BlocksAtRestAreSkippedAndNothingChanges) {
  for (const char* filter : {"off", "self_adjoint"}) {
    const Model all = pushed(false, false, {filter, 0.5}), computed = pushed(true, false, {filter, 0.5}),
                skipped = pushed(true, true, {filter, 0.5});
    const size_t bytes = all.state.x.size() * sizeof(Vec3);
    EXPECT_EQ(0, memcmp(computed.state.x.data(), skipped.state.x.data(), bytes)) << filter;
    EXPECT_EQ(0, memcmp(computed.state.v.data(), skipped.state.v.data(), bytes)) << filter;
    EXPECT_EQ(computed.state.t, skipped.state.t);
    const int64_t blocks = 80 * skipped.physics.elements.blocks.block_count();
    EXPECT_EQ(computed.physics.resting.skips, 0);
    EXPECT_GT(skipped.physics.resting.skips, blocks / 4) << filter;
    EXPECT_LT(skipped.physics.resting.skips, blocks);
    for (int i = 0; i < all.mesh.node_count(); ++i)  // round-off of the blocks at rest is all that differs
      ASSERT_LT(norm(all.state.x[NodeId(i)] - skipped.state.x[NodeId(i)]), 1e-14);
  }
}

/// Largest eigenfrequency of the whole model by dense eigenvalues.
double dense_omega(Model& m) {
  const int n = 3 * m.mesh.node_count();
  Eigen::MatrixXd K(n, n);
  const State start = m.state;
  const double h = 1e-9;
  for (int j = 0; j < n; ++j)
    for (int sign : {1, -1}) {
      m.state.x = start.x;
      m.state.x[NodeId(j / 3)][j % 3] += sign * h;
      first_forces(m);
      for (int i = 0; i < n; ++i) {
        const double f = -sign * m.state.f[NodeId(i / 3)][i % 3] / (2 * h);
        K(i, j) = sign > 0 ? f : K(i, j) + f;
      }
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) K(i, j) /= std::sqrt(start.m[NodeId(i / 3)] * start.m[NodeId(j / 3)]);
  m.state = start;
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(0.5 * (K + K.transpose())).eigenvalues()(n - 1));
}

TEST(StableStep, NeverUnsafeForTheAssembledModel) {
  for (const bool split : {false, true})
    for (const double perturbation : {0.0, 0.25}) {
      Box b;
      b.lower = {0, 0, 0}, b.upper = {0.01, 0.01, 0.01}, b.cells = split ? std::vector{2, 1, 1} : std::vector{3, 3, 3};
      b.grading = {1, 1, 8}, b.is_split = split;
      Mesh mesh = b.make();
      if (perturbation > 0) perturb_nodes(mesh, perturbation, 3);
      Model m = make_model(std::move(mesh), copper_elastic());
      const double exact = 2 / dense_omega(m);
      first_forces(m);
      double dt = stable(m);
      const double first = dt / exact;
      for (int i = 0; i < 30; ++i) {  // masses move to the stiff elements, refresh by refresh
        m.physics.time_step.renew();
        dt = stable(m);
        EXPECT_LE(dt, exact * (1 + 1e-6));
      }
      printf("split %d perturbation %.2f: stable/exact %.3f at first, %.3f after 30 refreshes\n", split, perturbation,
             first, dt / exact);
      EXPECT_GE(dt, 0.65 * exact);
    }
}

}  // namespace
}  // namespace bw::csd
