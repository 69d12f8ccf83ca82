// SPDX-License-Identifier: Apache-2.0
// Conditions against closed forms: friction, springs and dashpots, drag, prescribed displacement, planes of symmetry,
// dynamic relaxation, mass scaling, viscosity in the stable step.
#include <gtest/gtest.h>

#include "common/app/error.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

double mass(const State& s) {
  double m = 0;
  for (double a : s.m) m += a;
  return m;
}
double mean_velocity(const State& s, int d) {
  double p = 0;
  for (int n = 0; n < int(s.x.size()); ++n) p += s.m[NodeId(n)] * s.v[NodeId(n)][d];
  return p / mass(s);
}

TEST(Conditions, CoulombSlidesAndStops) {  // a block on a wall: deceleration mu g, path v^2/(2 mu g)
  RigidWall wall;
  wall.normal = {0, 0, 1}, wall.friction = "coulomb", wall.coefficient = 0.3, wall.separation = "node";
  Gravity g;
  g.acceleration = {0, 0, -1e5};
  const double v0 = 6;
  Model m = make_model(box({0, 0, 0}, {0.02, 0.02, 0.01}, {2, 2, 1}), copper_elastic(),
                       [&](const Vec3&) {
                         return Vec3{v0, 0, 0};
                       },
                       {wall}, {g});
  const double x0 = m.state.x[NodeId(0)].x, stop = v0 / (0.3 * 1e5);
  double half = 0;
  while (m.state.t < 1.5 * stop) {
    step(m, 0.5 * stable(m));
    if (half == 0 && m.state.t >= 0.5 * stop) half = mean_velocity(m.state, 0);
  }
  EXPECT_NEAR(half, 0.5 * v0, 0.02 * v0);
  EXPECT_NEAR(m.state.x[NodeId(0)].x - x0, v0 * v0 / (2 * 0.3 * 1e5), 0.02 * v0 * v0 / (2 * 0.3 * 1e5));
  EXPECT_NEAR(mean_velocity(m.state, 0), 0, 0.01 * v0);
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_LT(e.contact, -0.9 * 0.5 * mass(m.state) * v0 * v0);
  EXPECT_LT(std::fabs(e.residual), 0.01 * m.physics.energy.initial);
}

TEST(Conditions, FrictionOfAnImpactIsLimitedToo) {  // oblique impact: the wall takes mu of the normal impulse
  RigidWall wall;
  wall.normal = {0, 0, 1}, wall.friction = "coulomb", wall.coefficient = 0.2, wall.separation = "node";
  Model m = make_model(box({0, 0, 1e-4}, {0.02, 0.02, 0.0201}, {3, 3, 3}), copper_elastic(),
                       [&](const Vec3&) {
                         return Vec3{10, 0, -10};
                       },
                       {wall});
  Vec3 impulse;
  for (int n = 0; n < 200; ++n) {
    step(m, 0.5 * stable(m));
    impulse += std::get<RigidWall>(m.physics.conditions[0]).reaction.impulse;
  }
  EXPECT_GT(impulse.z, 0);
  EXPECT_NEAR(-impulse.x / impulse.z, 0.2, 0.01);
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 0.01 * m.physics.energy.initial);
}

/// A stiff block on springs at all of its nodes: their sum is one spring.
Model on_springs(double stiffness, double damping, const Vec3& v0, Vec3 direction = {}) {
  Spring spring;
  spring.nodes = "all", spring.stiffness = stiffness, spring.damping = damping, spring.direction = direction;
  Mesh mesh = box({0, 0, 0}, {0.01, 0.01, 0.01}, {1, 1, 1});
  for (int n = 0; n < mesh.node_count(); ++n) mesh.node_sets["all"].push_back(NodeId(n));
  return make_model(std::move(mesh), copper_elastic(), [=](const Vec3&) { return v0; }, {spring});
}

TEST(Conditions, SpringSwingsAtItsFrequency) {
  const double k = 1e8;
  Model m = on_springs(k, 0, {1, 0, 0});
  const double omega = std::sqrt(8 * k / mass(m.state)), x0 = m.state.x[NodeId(0)].x;
  const double dt = M_PI / omega / 400;
  for (int n = 0; n < 200; ++n) step(m, dt);  // a quarter of a period
  EXPECT_NEAR(m.state.x[NodeId(0)].x - x0, 1 / omega, 1e-3 / omega);
  EXPECT_NEAR(energy_row(m.physics, m.state).springs, -0.5 * mass(m.state), 2e-3 * mass(m.state));
  for (int n = 0; n < 200; ++n) step(m, dt);  // half
  EXPECT_NEAR(mean_velocity(m.state, 0), -1, 1e-3);
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-4 * m.physics.energy.initial);
}

TEST(Conditions, StiffSpringShortensTheStep) {
  Model soft = on_springs(1, 0, {}), stiff = on_springs(1e14, 0, {1, 0, 0});
  const double limit = stable_step(stiff);
  EXPECT_LT(limit, 0.5 * stable_step(soft));
  for (int n = 0; n < 2000; ++n) step(stiff, 0.95 * limit);
  EXPECT_LT(std::fabs(mean_velocity(stiff.state, 0)), 1.1);
}

TEST(Conditions, DashpotIsStableHoweverStrong) {
  Model weak = on_springs(0, 100, {1, 0, 0}, {1, 0, 0}), strong = on_springs(0, 1e12, {1, 2, 0}, {1, 0, 0});
  const double rate = 8 * 100 / mass(weak.state), end = 1 / rate;
  const int steps = int(end / (0.02 * stable(weak))) + 1;
  for (int n = 0; n < steps; ++n) step(weak, end / steps);
  EXPECT_NEAR(mean_velocity(weak.state, 0), std::exp(-1.0), 1e-3);
  EXPECT_NEAR(energy_row(weak.physics, weak.state).springs, -0.5 * mass(weak.state) * (1 - std::exp(-2.0)), 1e-5);
  for (int n = 0; n < 500; ++n) step(strong, 0.5 * stable(strong));
  EXPECT_LT(std::fabs(mean_velocity(strong.state, 0)), 1.0 + 1e-9);
  EXPECT_NEAR(mean_velocity(strong.state, 1), 2, 1e-6);  // across its direction it does nothing
}

TEST(Conditions, SpringBetweenTwoSetsKeepsMomentum) {
  Mesh a = box({0, 0, 0}, {0.01, 0.01, 0.01}, {1, 1, 1}), b = box({0.02, 0, 0}, {0.03, 0.01, 0.01}, {1, 1, 1});
  std::vector<Mesh> both{a, b};
  Mesh mesh = merge(std::move(both), {"a", "b"});
  for (int e = 0; e < mesh.elem_count(); ++e) mesh.body[ElemId(e)] = 0;
  Spring spring;
  spring.nodes = "a.x_upper", spring.to = "b.x_lower", spring.stiffness = 1e7, spring.damping = 50;
  Model m = make_model(std::move(mesh), copper_elastic(),
                       [](const Vec3& X) {
                         return X.x < 0.015 ? Vec3{4, 0, 0} : Vec3{};
                       },
                       {spring});
  const double before = mean_velocity(m.state, 0);
  for (int n = 0; n < 4000; ++n) step(m, 0.5 * stable_step(m));
  EXPECT_NEAR(mean_velocity(m.state, 0), before, 1e-10);
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_LT(std::fabs(e.residual), 1e-3 * m.physics.energy.initial);
  EXPECT_LT(e.springs, 0);
}

TEST(Conditions, DragDecaysExponentially) {
  Damping drag;
  drag.rate = 1e4, drag.until = 1.0001e-4;
  Model m = make_model(box({0, 0, 0}, {0.01, 0.01, 0.01}, {2, 2, 2}), copper_elastic(),
                       [](const Vec3&) {
                         return Vec3{0, 3, 0};
                       },
                       {drag});
  while (m.state.t < 1e-4 * (1 - 1e-9)) step(m, 1e-4 / 1000);
  EXPECT_NEAR(mean_velocity(m.state, 1), 3 * std::exp(-1.0), 1e-5);
  for (int n = 0; n < 100; ++n) step(m, 1e-7);
  EXPECT_NEAR(mean_velocity(m.state, 1), 3 * std::exp(-1.0), 2e-3);
  EXPECT_NEAR(energy_row(m.physics, m.state).residual, 0, 1e-9 * m.physics.energy.initial);
}

TEST(Conditions, DisplacementFollowsItsTable) {
  PrescribedDisplacement pull;
  pull.nodes = "x_upper", pull.direction = {1, 0, 0}, pull.table = {{0, 1e-5, 2e-5}, {0, 1e-5, 4e-6}};
  Roller hold;
  hold.nodes = "x_lower", hold.normal = {1, 0, 0};
  Model m = make_model(box({0, 0, 0}, {0.02, 0.01, 0.01}, {4, 2, 2}), copper_elastic(), {}, {hold, pull});
  const NodeId n = m.mesh.node_sets.at("x_upper")[0];
  while (m.state.t < 3e-5) {
    step(m, 0.7 * stable(m));
    EXPECT_NEAR(m.state.x[n].x - 0.02, pull.table.at(m.state.t), 1e-15);
  }
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 0.02 * energy_row(m.physics, m.state).conditions);
}

TEST(Conditions, SpringsOnHeldNodesPullBeforeTheyAreHeldWhateverTheOrder) {
  PrescribedDisplacement pull;
  pull.nodes = "x_upper", pull.direction = {1, 0, 0}, pull.table = {{0, 2e-5}, {0, 4e-5}};
  Spring spring;
  spring.nodes = "x_upper", spring.stiffness = 2e8;
  const auto run = [&](std::vector<ConditionKind> conditions) {
    Model m = make_model(box({0, 0, 0}, {0.02, 0.01, 0.01}, {4, 2, 2}), copper_elastic(), {}, std::move(conditions));
    const double dt = 0.7 * stable(m);
    while (m.state.t < 2e-5) step(m, dt);
    return energy_row(m.physics, m.state);
  };
  const EnergyRow one = run({pull, spring}), two = run({spring, pull});
  EXPECT_EQ(one.conditions, two.conditions);
  EXPECT_LT(std::fabs(one.residual), 0.01 * std::fabs(one.springs));
}

TEST(Conditions, SymmetryIsHalfOfTheWhole) {
  const auto velocity = [](const Vec3& X) { return Vec3{100 * X.x * (0.3 + X.y), 20 * X.y * X.y, 0}; };
  Symmetry plane;
  plane.normal = {1, 0, 0};
  Model whole = make_model(box({-0.1, 0, 0}, {0.1, 0.1, 0.1}, {8, 4, 4}), copper_elastic(), velocity);
  Model half = make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4}), copper_elastic(), velocity, {plane});
  for (int n = 0; n < 50; ++n) step(whole, 1e-6), step(half, 1e-6);
  for (int n = 0; n < half.mesh.node_count(); ++n)
    for (int k = 0; k < whole.mesh.node_count(); ++k)
      if (norm(whole.mesh.X[NodeId(k)] - half.mesh.X[NodeId(n)]) < 1e-9) {
        EXPECT_LT(norm(whole.state.x[NodeId(k)] - half.state.x[NodeId(n)]), 1e-13);
      }
  EXPECT_THROW(plane.select(whole.mesh), InputError);  // it stands on both sides
  plane.point = {-5, 0, 0};
  EXPECT_THROW(plane.select(half.mesh), InputError);  // no node there
}

TEST(Conditions, RelaxationFindsTheStaticBar) {  // u = F L / (E A), uniaxial stress
  Traction pull;
  pull.faces = {"x_upper"}, pull.total = {1e4, 0, 0};
  Roller x, y, z;
  x.nodes = "x_lower", x.normal = {1, 0, 0}, y.nodes = "y_lower", y.normal = {0, 1, 0}, z.nodes = "z_lower",
  z.normal = {0, 0, 1};
  Model m = make_model(box({0, 0, 0}, {0.1, 0.01, 0.01}, {10, 1, 1}), copper_elastic(), {}, {x, y, z}, {pull});
  m.physics.relaxation.emplace(RelaxationCase{}, m.state.x.size());
  int steps = 0;
  while (steps < 20 || (static_imbalance(m.physics) > 1e-6 && steps < 5000)) step(m, 0.9 * stable(m)), ++steps;
  EXPECT_LT(steps, 1500);
  const double strain = 1e4 / 1e-4 / 117e9;
  EXPECT_NEAR(m.state.x[m.mesh.node_sets.at("x_upper")[0]].x - 0.1, 0.1 * strain, 2e-3 * 0.1 * strain);
  EXPECT_NEAR(energy_row(m.physics, m.state).elastic, 0.5 * 1e4 * 0.1 * strain, 5e-3 * 0.5 * 1e4 * 0.1 * strain);
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-3 * 1e4 * 0.1 * strain);
}

/// Two halves of a bar, the second with `cells` of its own, in one model.
Mesh two_halves(std::vector<int> cells) {
  std::vector<Mesh> both{box({0, 0, 0}, {0.05, 0.01, 0.01}, {10, 2, 2}), box({0.05, 0, 0}, {0.1, 0.01, 0.01}, cells)};
  Mesh mesh = merge(std::move(both), {"a", "b"});
  for (int e = 0; e < mesh.elem_count(); ++e) mesh.body[ElemId(e)] = 0;
  return mesh;
}
Vec3 hit(const Vec3& X) { return X.x < 0.02 ? Vec3{10, 1, 0} : Vec3{}; }

TEST(Tie, MatchingMeshesMoveAsOne) {
  Tie tie;
  tie.nodes = "b.x_lower", tie.faces = {"a.x_upper"};
  Model tied = make_model(two_halves({10, 2, 2}), copper_elastic(), hit, {tie});
  Model whole = make_model(box({0, 0, 0}, {0.1, 0.01, 0.01}, {20, 2, 2}), copper_elastic(), hit);
  EXPECT_EQ(std::get<Tie>(tied.physics.conditions[0]).tied(), 9u);
  for (int n = 0; n < 300; ++n) step(tied, 4e-7), step(whole, 4e-7);
  for (int n = 0; n < tied.mesh.node_count(); ++n)
    for (int k = 0; k < whole.mesh.node_count(); ++k)
      if (norm(whole.mesh.X[NodeId(k)] - tied.mesh.X[NodeId(n)]) < 1e-9) {
        EXPECT_LT(norm(whole.state.x[NodeId(k)] - tied.state.x[NodeId(n)]), 1e-12);
      }
  EXPECT_LT(std::fabs(energy_row(tied.physics, tied.state).conditions), 1e-9 * tied.physics.energy.initial);
}

TEST(Tie, OtherMeshesKeepMomentumAndEnergy) {
  Tie tie;
  tie.nodes = "b.x_lower", tie.faces = {"a.x_upper"};
  Model m = make_model(two_halves({15, 3, 3}), copper_elastic(), hit, {tie});
  const Vec3 before{mean_velocity(m.state, 0), mean_velocity(m.state, 1), mean_velocity(m.state, 2)};
  for (int n = 0; n < 400; ++n) step(m, 0.9 * stable(m));
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(mean_velocity(m.state, d), before[d], 1e-10);
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_LT(std::fabs(e.residual), 2e-3 * m.physics.energy.initial);
  EXPECT_LT(std::fabs(e.conditions), 0.02 * m.physics.energy.initial);
  double gap = 0;  // the tied plane stays closed
  for (NodeId n : m.mesh.node_sets.at("b.x_lower"))
    for (NodeId k : m.mesh.node_sets.at("a.x_upper"))
      if (norm(m.mesh.X[n] - m.mesh.X[k]) < 1e-9) gap = std::fmax(gap, norm(m.state.x[n] - m.state.x[k]));
  EXPECT_LT(gap, 1e-12);
}

TEST(Tie, ApartIsApartAndFarIsRefused) {
  Model m = make_model(two_halves({10, 2, 2}), copper_elastic(), hit);
  for (int n = 0; n < 100; ++n) step(m, 4e-7);
  for (NodeId n : m.mesh.node_sets.at("b.x_upper")) EXPECT_LT(norm(m.state.v[n]), 1e-9);
  Tie tie;
  tie.nodes = "b.x_upper", tie.faces = {"a.x_upper"};
  EXPECT_THROW(tie.select(m.mesh), InputError);
}

TEST(MassScaling, HoldsTheStepAndIsBooked) {
  Box b;
  b.lower = {0, 0, 0}, b.upper = {0.1, 0.01, 0.01}, b.cells = {20, 2, 2}, b.grading = {5, 1, 1};
  Model m = make_model(b.make(), copper_elastic(), [](const Vec3&) { return Vec3{10, 0, 0}; });
  const double natural = stable(m), before = mass(m.state), dt = 1.3 * natural;
  MassScaling scaling({dt, 0.5}, m.state);
  const double stable_after = scaling.enforce(m.mesh, m.physics.elements, m.physics.time_step, 1.0, natural, m.state);
  EXPECT_GE(stable_after, dt);
  EXPECT_GT(scaling.added_mass(), 0);
  EXPECT_NEAR(mass(m.state) - before, scaling.added_mass(), 1e-12 * before);
  EXPECT_NEAR(scaling.added_energy(), 50 * scaling.added_mass(), 1e-9);
  m.physics.mass_scaling = scaling;
  EXPECT_NEAR(energy_row(m.physics, m.state).residual, 0, 1e-9 * m.physics.energy.initial);
  for (int n = 0; n < 500; ++n) step(m, 0.98 * stable_after);  // it is stable, too
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-6 * m.physics.energy.initial);
  MassScaling little({dt, 1e-6}, m.state);
  m.physics.time_step.renew();
  Model fresh = make_model(b.make(), copper_elastic());
  EXPECT_THROW(
      little.enforce(fresh.mesh, fresh.physics.elements, fresh.physics.time_step, 1.0, stable(fresh), fresh.state),
      PhysicsError);
}

TEST(StableStep, KnowsViscosity) {  // also where the bound has just been computed anew
  Model m = make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {3, 3, 3}), copper_elastic(),
                       [](const Vec3& X) { return -50.0 * X; }, {}, {}, {}, {0.06, 1.5});
  for (int n = 0; n < 3; ++n) step(m, 0.2 * stable(m));
  m.physics.time_step.renew();
  const double with = stable(m);
  const double c1 = 0.06, h = std::cbrt(m.state.volume[SlotId(0)]), c = copper.sound_speed();
  const double kappa = copper.volumetric.kappa, rate = 150;
  const double beta = copper.density * h * (c1 * c + 2.25 * h * rate) / kappa;
  EXPECT_NEAR(m.state.viscous_time[SlotId(0)], beta, 0.02 * beta);
  m.state.viscous_time.resize(0);
  m.physics.time_step.renew();
  const double without = stable(m), xi = beta / without;  // omega beta / 2
  EXPECT_NEAR(with / without, std::sqrt(1 + xi * xi) - xi, 0.01);
  EXPECT_LT(with, 0.95 * without);
}

}  // namespace
}  // namespace bw::csd
