// SPDX-License-Identifier: Apache-2.0
// Rigid bodies: free motion (C9), the switch from deformable and back (T10), loads as force and moment, walls.
#include <gtest/gtest.h>

#include <numbers>

#include "csd/fragments/impact.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

struct Nodes {
  Field<Vec3, NodeId> x, v;
  Field<double, NodeId> m;
  RigidBody body(RigidBody::Motion motion = RigidBody::Motion::six_dof) const {
    std::vector<NodeId> all;
    for (int n = 0; n < int(x.size()); ++n) all.push_back(NodeId(n));
    return {all, x, v, m, motion};
  }
};
/// Corners of a box with sides of 1, 2, 3 times h, which spins.
Nodes brick(const Vec3& spin, const Vec3& drift = {}, const Vec3& sides = {1e-3, 2e-3, 3e-3}) {
  Nodes b;
  for (int i = 0; i < 8; ++i) {
    const Vec3 r{(i & 1 ? 0.5 : -0.5) * sides.x, (i & 2 ? 0.5 : -0.5) * sides.y, (i & 4 ? 0.5 : -0.5) * sides.z};
    b.x.push_back(r), b.v.push_back(drift + cross(spin, r)), b.m.push_back(1e-6);
  }
  return b;
}

TEST(C9, FreeSpinAboutAPrincipalAxis) {
  for (const Vec3& spin : {Vec3{2e4, 0, 0}, Vec3{0, 0, 2e4}}) {
    const Nodes nodes = brick(spin, {100, -50, 20});
    RigidBody body = nodes.body();
    const Vec3 p = body.mass() * body.velocity(), L = body.angular_momentum();
    const double energy = body.kinetic_energy();
    double p_error = 0, L_error = 0, energy_error = 0;
    for (int n = 0; n < 1000000; ++n) {
      body.drift(5e-8);
      if (n % 1000 != 999) continue;
      Field<Vec3, NodeId> x = nodes.x, v = nodes.v;
      body.place_nodes(x), body.move_nodes(v);
      Vec3 p_now, L_now;  // from the nodes, as a reader of the output sees them
      double energy_now = 0;
      for (int i = 0; i < 8; ++i) {
        const NodeId k(i);
        p_now += nodes.m[k] * v[k], energy_now += 0.5 * nodes.m[k] * dot(v[k], v[k]);
        L_now += nodes.m[k] * cross(x[k] - body.centre(), v[k]);
      }
      p_error = std::fmax(p_error, norm(p_now - p) / norm(p));
      L_error = std::fmax(L_error, norm(L_now - L) / norm(L));
      energy_error = std::fmax(energy_error, std::fabs(energy_now / energy - 1));
    }
    record("momentum_change", p_error), record("angular_momentum_change", L_error);
    record("kinetic_energy_change", energy_error);
    EXPECT_LT(p_error, 1e-12);
    EXPECT_LT(L_error, 1e-12);
    EXPECT_LT(energy_error, 1e-12);
  }
}

TEST(C9, FreeTumbling) {
  RigidBody body = brick({100, 2e4, 300}).body();  // about the middle axis: it turns over again and again
  const Vec3 L = body.angular_momentum();
  const double energy = body.kinetic_energy();
  double change = 0, overturned = 0;
  for (int n = 0; n < 1000000; ++n) {
    body.drift(5e-8);
    change = std::fmax(change, std::fabs(body.kinetic_energy() / energy - 1));
    overturned = std::fmin(overturned, dot(body.arm(7) - body.arm(5), Vec3{0, 1, 0}) / 2e-3);
  }
  record("kinetic_energy_change_tumbling", change);
  EXPECT_LT(change, 1e-8);
  EXPECT_LT(overturned, -0.99);
  EXPECT_EQ(body.angular_momentum(), L);
}

TEST(C9, SpinningCubeReturns) {
  const Nodes nodes = brick({3e3, 4e3, 0}, {}, {1e-3, 1e-3, 1e-3});
  RigidBody body = nodes.body();
  const int steps = 500;
  for (int n = 0; n < steps; ++n) body.drift(2 * std::numbers::pi / 5e3 / steps);
  Field<Vec3, NodeId> x = nodes.x;
  body.place_nodes(x);
  double off = 0, side = 0;
  for (int i = 0; i < 8; ++i) off = std::fmax(off, norm(x[NodeId(i)] - nodes.x[NodeId(i)]) / 1e-3);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j)
      side = std::fmax(
          side, std::fabs(norm(x[NodeId(i)] - x[NodeId(j)]) / norm(nodes.x[NodeId(i)] - nodes.x[NodeId(j)]) - 1));
  record("off_after_a_revolution_over_side", off), record("shape_change", side);
  EXPECT_LT(off, 1e-11);
  EXPECT_LT(side, 1e-10);
}

/// Fourth order in the step, against a fine one.
TEST(RigidBody, TumblesWithFourthOrder) {
  const auto end = [](int steps) {
    RigidBody body = brick({3e3, 2e4, 5e3}).body();
    for (int n = 0; n < steps; ++n) body.drift(1e-3 / steps);
    return body.arm(7);
  };
  const Vec3 exact = end(16000);
  const double coarse = norm(end(200) - exact), fine = norm(end(400) - exact);
  EXPECT_GT(coarse, 1e-11);
  EXPECT_NEAR(std::log2(coarse / fine), 4, 0.3);
}

Vec3 momentum(const State& s) {
  Vec3 p;
  for (int n = 0; n < int(s.x.size()); ++n) p += s.m[NodeId(n)] * s.v[NodeId(n)];
  return p;
}
Vec3 angular_momentum(const State& s) {
  Vec3 L;
  for (int n = 0; n < int(s.x.size()); ++n) L += s.m[NodeId(n)] * cross(s.x[NodeId(n)], s.v[NodeId(n)]);
  return L;
}

Model spinning_bar(const RigidInput& input, const std::function<Vec3(const Vec3&)>& more = {}) {
  Model m = make_model(box({0, 0, 0}, {0.02, 0.004, 0.004}, {10, 2, 2}), copper_elastic(), [&](const Vec3& X) {
    return Vec3{30, 0, 10} + cross({0, 400, 4000}, X) + (more ? more(X) : Vec3{});
  });
  m.physics.rigid.emplace(input, std::vector<std::string>{"bar"}, m.mesh);
  m.physics.rigid->start(m);
  m.physics.energy.initial = 0;
  m.physics.energy.initial = energy_row(m.physics, m.state).residual;
  return m;
}

TEST(T10, SwitchesEveryTenStepsKeepBothMomenta) {
  const double dt = 2e-8;
  RigidInput input;
  input.bodies = {"bar"};
  for (int k = 1; k < 100; ++k) input.switch_times.push_back(10 * k * dt);
  Model m = spinning_bar(input);
  const Vec3 p = momentum(m.state), L = angular_momentum(m.state);
  const double start = energy_row(m.physics, m.state).kinetic;
  double p_error = 0, L_error = 0, residual = 0, total = start, growth = 0;
  int switches = 0;
  for (int n = 0; n < 1000; ++n) {
    const size_t before = m.physics.rigid->bodies().size();
    step(m, dt);
    complete(m);
    const EnergyRow row = energy_row(m.physics, m.state);
    p_error = std::fmax(p_error, norm(momentum(m.state) - p) / norm(p));
    L_error = std::fmax(L_error, norm(angular_momentum(m.state) - L) / norm(L));
    residual = std::fmax(residual, std::fabs(row.residual) / start);
    if (m.physics.rigid->bodies().size() == before) continue;
    ++switches;
    growth = std::fmax(growth, (row.kinetic + row.elastic) / total - 1), total = row.kinetic + row.elastic;
  }
  record("momentum_change", p_error), record("angular_momentum_change", L_error);
  record("energy_growth", growth), record("energy_residual", residual);
  EXPECT_EQ(switches, 99);
  EXPECT_LT(p_error, 1e-12);
  EXPECT_LT(L_error, 1e-12);
  EXPECT_LT(growth, 1e-12);
  EXPECT_LT(residual, 1e-8);
  EXPECT_GT(m.physics.energy.rigidization, 0);
}

TEST(C9, SwitchLosesTheInnerMotionAlone) {
  const auto wave = [](const Vec3& X) { return Vec3{20 * std::sin(300 * X.x), 5 * std::cos(900 * X.y), 0}; };
  Model free = make_model(box({0, 0, 0}, {0.02, 0.004, 0.004}, {10, 2, 2}), copper_elastic(), [&](const Vec3& X) {
    return Vec3{30, 0, 10} + cross({0, 400, 4000}, X) + wave(X);
  });
  const Vec3 p = momentum(free.state), L = angular_momentum(free.state);
  const double before = kinetic_energy(free.state);
  RigidInput input;
  input.bodies = {"bar"};
  Model m = std::move(free);
  m.physics.rigid.emplace(input, std::vector<std::string>{"bar"}, m.mesh);
  m.physics.rigid->start(m);
  const double after = kinetic_energy(m.state);
  EXPECT_LT(norm(momentum(m.state) - p), 1e-12 * norm(p));
  EXPECT_LT(norm(angular_momentum(m.state) - L), 1e-12 * norm(L));
  EXPECT_LT(after, before);
  EXPECT_NEAR(m.physics.energy.rigidization, before - after, 1e-10 * before);
  // the rigid motion is the nearest one: what is lost is orthogonal to every rigid motion
  const RigidBody& body = m.physics.rigid->bodies()[0];
  EXPECT_NEAR(body.kinetic_energy(), after, 1e-13 * after);
}

TEST(Rigid, ElementsCostNothingAndLimitNothing) {
  RigidInput input;
  input.bodies = {"bar"};
  Model m = spinning_bar(input);
  const auto x0 = m.state.x;
  for (int n = 0; n < 200; ++n) step(m, 1e-7);
  complete(m);
  EXPECT_EQ(m.physics.resting.rigid_skips, 200 * m.physics.elements.blocks.block_count());
  EXPECT_TRUE(std::isinf(stable(m)));
  EXPECT_LT(stable_step(m), 1);
  double shape = 0;
  for (int n = 1; n < m.mesh.node_count(); ++n) {
    const double now = norm(m.state.x[NodeId(n)] - m.state.x[NodeId(0)]), then = norm(x0[NodeId(n)] - x0[NodeId(0)]);
    shape = std::fmax(shape, std::fabs(now / then - 1));
  }
  EXPECT_LT(shape, 1e-10);
  EXPECT_GT(norm(m.state.x[NodeId(0)] - x0[NodeId(0)]), 6e-4);
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-11 * kinetic_energy(m.state));
}

TEST(Rigid, PressureGivesForceAndMoment) {
  Pressure load;
  load.table = {{0.0}, {1e7}};
  load.faces = {"x_lower"};
  BodyForce weight;  // of no moment
  weight.density = {0, 0, -3e6};
  Model m = make_model(box({0, 0, 0}, {0.01, 0.02, 0.03}, {3, 2, 2}), copper_elastic(), {}, {}, {load, weight});
  RigidInput input;
  input.bodies = {"a"};
  m.physics.rigid.emplace(input, std::vector<std::string>{"a"}, m.mesh);
  m.physics.rigid->start(m);
  const double dt = 1e-8, area = 0.02 * 0.03, mass = 8930 * 6e-6;
  for (int n = 0; n < 10; ++n) step(m, dt);
  complete(m);
  const RigidBody& body = m.physics.rigid->bodies()[0];
  EXPECT_NEAR(body.mass(), mass, 1e-13 * mass);
  EXPECT_NEAR(body.velocity().x, 1e7 * area / mass * 10 * dt, 1e-12);
  EXPECT_NEAR(body.velocity().z, -3e6 * 6e-6 / mass * 10 * dt, 1e-12);
  EXPECT_LT(norm(body.angular_momentum()), 1e-15);
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-12 * kinetic_energy(m.state));
}

TEST(Rigid, EccentricForceTurnsIt) {
  for (const char* motion : {"six_dof", "mean_force"}) {
    Traction load;  // along y on the face x = lower, whose lever is half the length
    load.traction = {0, 1e6, 0};
    load.faces = {"x_lower"};
    Model m = make_model(box({0, 0, 0}, {0.03, 0.01, 0.01}, {3, 1, 1}), copper_elastic(), {}, {}, {load});
    RigidInput input;
    input.bodies = {"a"}, input.motion = motion;
    m.physics.rigid.emplace(input, std::vector<std::string>{"a"}, m.mesh);
    m.physics.rigid->start(m);
    for (int n = 0; n < 100; ++n) step(m, 1e-6);
    complete(m);
    const RigidBody& body = m.physics.rigid->bodies()[0];
    EXPECT_NEAR(body.velocity().y, 1e6 * 1e-4 / body.mass() * 1e-4, 1e-9);
    const double moment = motion == std::string("six_dof") ? -1e6 * 1e-4 * 0.015 * 1e-4 : 0;
    EXPECT_NEAR(body.angular_momentum().z, moment, 1e-5 * 1.5e-4);  // it turns by 4e-3, and the lever with it
    EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-7 * kinetic_energy(m.state));
  }
}

TEST(Rigid, SmallFragmentsOfACrackedBarBecomeRigid) {
  for (const double age : {0.0, 3e-6}) {
    Model m = make_model(box({0, 0, 0}, {0.04, 0.01, 0.01}, {12, 3, 3}, 0.1), copper_j2(), [](const Vec3& X) {
      return Vec3{1.5e4 * (X.x - 0.02), 0, 0};
    });
    FractureInput fracture;
    fracture.criterion.model = EqpsLimit{0.1};
    m.physics.cracks.emplace(fracture, m.mesh, 0.0);
    RigidInput input;
    input.elements = 20, input.age = age, input.every = 1;
    m.physics.rigid.emplace(input, std::vector<std::string>{"bar"}, m.mesh);
    m.physics.rigid->start(m);
    const Vec3 p = momentum(m.state);
    double first = -1;
    for (int n = 0; n < 400; ++n) {
      step(m, 0.9 * stable(m));
      if (first < 0 && !m.physics.rigid->bodies().empty()) first = m.state.t;
    }
    const auto& rigid = *m.physics.rigid;
    ASSERT_GT(rigid.bodies().size(), 3u);
    EXPECT_LT(rigid.elements(), m.mesh.elem_count());
    EXPECT_LT(norm(momentum(m.state) - p), 1e-12 * 8930 * 4e-6 * 300);
    EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 0.01 * m.physics.energy.initial);
    EXPECT_GT(m.physics.energy.rigidization, 0);
    double born = 1e300;
    const Fragments& f = m.physics.cracks->fragments(m);
    for (int label = 1; label < f.count(); ++label) born = std::fmin(born, f.birth(label));
    EXPECT_GE(first, born + age);
  }
}

TEST(Rigid, StrainedFragmentsWait) {
  Model m = spinning_bar({});
  RigidInput input;
  input.elements = 1000, input.every = 1, input.stress = 1;  // Pa: never calm, and a body as it began is no fragment
  m.physics.rigid.emplace(input, std::vector<std::string>{"bar"}, m.mesh);
  m.physics.rigid->start(m);
  for (int n = 0; n < 20; ++n) step(m, 1e-8);
  EXPECT_TRUE(m.physics.rigid->bodies().empty());
}

// --- walls

std::vector<Touch> touches_of(const RigidBody& body, double gap, double restitution, double friction) {
  std::vector<Touch> touches;
  for (size_t i = 0; i < body.nodes().size(); ++i) {
    const Vec3 arm = body.arm(i);
    if (body.centre().z + arm.z < gap) touches.push_back({arm, {0, 0, 1}, {}, 0, restitution, friction});
  }
  return touches;
}

TEST(Impact, FlatCubeReversesByItsRestitution) {
  Nodes nodes = brick({}, {30, 0, -100}, {1e-3, 1e-3, 1e-3});
  for (const double e : {0.0, 0.4, 1.0}) {
    RigidBody body = nodes.body();
    auto touches = touches_of(body, -0.4e-3, e, 0);
    ASSERT_EQ(touches.size(), 4u);
    ASSERT_TRUE(resolve(body, touches));
    EXPECT_NEAR(body.velocity().z, 100 * e, 1e-8);
    EXPECT_NEAR(body.velocity().x, 30, 1e-10);
    EXPECT_LT(norm(body.spin()), 1e-4);
  }
}

/// One corner first: the impulse in closed form, (1 + e) v / (1/m + n . (I^-1 (r x n)) x r).
TEST(Impact, CornerAgainstTheClosedForm) {
  RigidBody body = brick({200, -300, 100}, {0, 0, -50}).body();
  const Vec3 n{0, 0, 1}, r = body.arm(0);
  const double v = dot(body.velocity_at(r), n), e = 0.6;
  const double J = -(1 + e) * v / dot(n, body.response(r, r, n)), vz = body.velocity().z;
  std::vector<Touch> touches{{r, n, {}, 0, e, 0}};
  ASSERT_TRUE(resolve(body, touches));
  EXPECT_NEAR(touches[0].impulse.z, J, 1e-12 * J);
  EXPECT_NEAR(dot(body.velocity_at(r), n), -e * v, 1e-10);
  EXPECT_NEAR(body.velocity().z, vz + J / body.mass(), 1e-10);
}

TEST(Impact, NeverGainsEnergyAndNeverPasses) {
  double gain = -1;
  for (uint64_t i = 0; i < 2000; ++i) {
    const auto random = [&](uint64_t k) { return noise(i, k); };
    Nodes nodes = brick({2e5 * random(0), 2e5 * random(1), 2e5 * random(2)}, {100 * random(3), 0, -100});
    RigidBody body = nodes.body();
    body.drift(1e-5);
    const double e = 0.5 + 0.5 * random(4), mu = 1 + random(5);
    auto touches = touches_of(body, body.centre().z, e, mu);
    const double before = body.kinetic_energy();
    if (!resolve(body, touches)) continue;
    gain = std::fmax(gain, body.kinetic_energy() / before - 1);
    for (const Touch& t : touches) {
      EXPECT_GE(body.velocity_at(t.arm).z, -1e-4 * 100);
      EXPECT_LE(std::hypot(t.impulse.x, t.impulse.y), mu * t.impulse.z * (1 + 1e-12) + 1e-30);
    }
  }
  record("largest_gain", gain);
  EXPECT_LT(gain, 1e-11);
  EXPECT_GT(gain, -1);
}

Model thrown(const RigidWall& wall, const Vec3& velocity, std::vector<LoadKind> loads = {}) {
  Model m = make_model(
      box({0, 0, 1e-3}, {2e-3, 2e-3, 3e-3}, {2, 2, 2}), copper_elastic(), [&](const Vec3&) { return velocity; }, {wall},
      std::move(loads));
  RigidInput input;
  input.bodies = {"a"};
  m.physics.rigid.emplace(input, std::vector<std::string>{"a"}, m.mesh);
  m.physics.rigid->start(m);
  m.physics.energy.initial = 0;
  m.physics.energy.initial = energy_row(m.physics, m.state).residual;
  return m;
}

TEST(Rigid, BouncesOffAWall) {
  RigidWall wall;
  wall.normal = {0, 0, 1}, wall.restitution = 0.5;
  Model m = thrown(wall, {10, 0, -100});
  double lowest = 1;
  for (int n = 0; n < 300; ++n) {
    step(m, 1e-7);
    for (const Vec3& x : m.state.x) lowest = std::fmin(lowest, x.z);
  }
  EXPECT_GT(lowest, -1e-9);
  EXPECT_NEAR(m.physics.rigid->bodies()[0].velocity().z, 50, 1e-6);
  EXPECT_NEAR(m.physics.rigid->bodies()[0].velocity().x, 10, 1e-6);
  const EnergyRow row = energy_row(m.physics, m.state);
  EXPECT_NEAR(row.contact, -0.75 * 0.5 * 8930 * 8e-9 * 1e4, 1e-6 * 0.36);
  EXPECT_LT(std::fabs(row.residual), 1e-10 * row.kinetic);
}

TEST(Rigid, SlidesToAStopByFriction) {  // under its weight: mu g
  RigidWall wall;
  wall.normal = {0, 0, 1}, wall.friction = "coulomb", wall.coefficient = 0.3, wall.point = {0, 0, 1e-3};
  Gravity gravity;
  gravity.acceleration = {0, 0, -1e5};
  Model m = thrown(wall, {3, 0, 0}, {gravity});
  const double x0 = m.physics.rigid->bodies()[0].centre().x;
  for (int n = 0; n < 400; ++n) step(m, 5e-7);
  EXPECT_NEAR(norm(m.physics.rigid->bodies()[0].velocity()), 1e5 * 0.5 * 5e-7, 1e-9);  // half a step's fall
  EXPECT_NEAR(m.physics.rigid->bodies()[0].centre().x - x0, 9 / (2 * 0.3 * 1e5), 0.02 * 1.5e-4);
  EXPECT_NEAR(m.physics.rigid->bodies()[0].centre().z, 2e-3, 1e-7);
}

TEST(Rigid, AMovingWallTakesItAlong) {
  RigidWall wall;
  wall.normal = {0, 0, 1}, wall.velocity = {0, 0, 1}, wall.factor = Table{{0, 1e-5}, {0, 20}};
  Model m = thrown(wall, {});
  for (int n = 0; n < 1500; ++n) step(m, 1e-7);  // the wall is at 20 (t - 5e-6) m
  EXPECT_NEAR(m.physics.rigid->bodies()[0].velocity().z, 20, 1e-9);
  EXPECT_NEAR(m.physics.rigid->bodies()[0].centre().z, 20 * (1.5e-4 - 5e-6) + 1e-3, 1e-8);
  const EnergyRow row = energy_row(m.physics, m.state);
  EXPECT_NEAR(row.contact, row.kinetic, 1e-10 * row.kinetic);
}

TEST(Rigid, LeavingTheBoxIsRecordedAndCostsNothing) {
  for (const bool becomes_rigid : {false, true}) {  // a deformable body too is retired
    Mesh mesh = merge({box({0, 0, 0}, {1e-3, 1e-3, 1e-3}, {2, 2, 2}), box({0, 0, 2e-3}, {1e-3, 1e-3, 3e-3}, {2, 2, 2})},
                      {"a", "b"});
    for (int e = 8; e < 16; ++e) mesh.body[ElemId(e)] = 0;
    Model m = make_model(std::move(mesh), copper_elastic(), [](const Vec3& X) {
      return X.z > 1.5e-3 ? Vec3{0, 0, 200} + cross({0, 0, 1e4}, X - Vec3{5e-4, 5e-4, 0}) : Vec3{0, 0, -1};
    });
    RigidInput input;
    input.every = 1, input.box = BoxInput{{-0.1, -0.1, -0.1}, {0.1, 0.1, 5e-3}};
    if (becomes_rigid) input.bodies = {"b"};
    for (int e = 8; e < 16; ++e) m.mesh.body[ElemId(e)] = becomes_rigid;  // two names
    m.physics.rigid.emplace(input, std::vector<std::string>{"a", "b"}, m.mesh);
    m.physics.rigid->start(m);
    const Vec3 p = momentum(m.state);
    const double before = kinetic_energy(m.state);
    for (int n = 0; n < 400; ++n) step(m, 5e-8);
    const auto* left = m.physics.rigid->left();
    ASSERT_EQ(left->count, 1);
    EXPECT_NEAR(left->mass, 8930e-9, 1e-18);
    EXPECT_LT(norm(momentum(m.state) + left->momentum - p), 1e-13 * norm(p));
    EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 1e-6 * before);
    EXPECT_GT(m.physics.resting.rigid_skips, 0);
    std::vector<double> eqps(16, 0.0);
    auto table = m.physics.rigid->fragments(m).table(m.mesh, m.topology, {m.state.x, m.state.v, m.state.m, eqps});
    EXPECT_EQ(table[1].kinetic_energy, 0);
    m.physics.rigid->add_left(m, table);
    EXPECT_EQ(table[0].left, -1);
    EXPECT_NEAR(table[1].left, 3e-3 / 200, 1e-7);  // its lower end at the box's upper side
    EXPECT_NEAR(table[1].velocity.z, 200, 1e-9);
    EXPECT_NEAR(table[1].spin.z, 1e4, becomes_rigid ? 1e-6 : 100);
    EXPECT_NEAR(table[1].lower.z, 5e-3, 2e-5);
  }
}

/// Flight of a cube of 2 mm that starts at 2 km/s: speed and way after `end`, energy residual over the kinetic one.
struct Flight {
  double v, x, residual;
};
Flight flight(const DragInput& drag, double end, int steps) {
  Model m = make_model(box({-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}, {2, 2, 2}), copper_elastic(), [](const Vec3&) {
    return Vec3{1600, 0, -1200};
  });
  RigidInput input;
  input.bodies = {"a"}, input.drag = drag;
  m.physics.rigid.emplace(input, std::vector<std::string>{"a"}, m.mesh);
  m.physics.rigid->start(m);
  const double energy = kinetic_energy(m.state);
  for (int n = 0; n < steps; ++n) step(m, end / steps);
  const RigidBody& body = m.physics.rigid->bodies()[0];
  EXPECT_LT(norm(cross(body.velocity(), {0.8, 0, -0.6})), 1e-9);
  EXPECT_LT(norm(body.angular_momentum()), 1e-14 * body.mass() * 2000 * 1e-3);
  return {norm(body.velocity()), norm(body.centre()), std::fabs(energy_row(m.physics, m.state).residual) / energy};
}

TEST(Rigid, DragOfStillAir) {
  DragInput air;
  air.density = 1.2, air.sound_speed = 340, air.mach = {0}, air.coefficient = {1.2};
  const double mass = 8930 * 8e-9, area = 6 * 4e-6 / 4, L = 2 * mass / (1.2 * 1.2 * area), end = 1e-2;
  const double v = 2000 / (1 + 2000 * end / L), x = L * std::log(1 + 2000 * end / L);
  double error[2];
  for (int i = 0; i < 2; ++i) {
    const Flight f = flight(air, end, 200 << i);
    error[i] = f.v / v - 1;
    EXPECT_LT(std::fabs(f.x / x - 1), 2e-5);
    EXPECT_LT(f.residual, 1e-6);
  }
  record("drag_error", std::fabs(error[1]));
  EXPECT_LT(std::fabs(error[0]), 1e-5);
  EXPECT_NEAR(error[0] / error[1], 4, 0.4);  // second order
  air.shape_factor = area / std::cbrt(mass * mass);
  EXPECT_NEAR(flight(air, end, 200).v / v - 1, error[0], 1e-12);
  air.size = 2 * std::sqrt(3.0) * 1e-3 * 0.99;  // the corners are further out
  EXPECT_NEAR(flight(air, end, 200).v, 2000, 1e-9);
  air.size *= 1.02, air.mach = {0.5, 1, 3}, air.coefficient = {0.6, 1.4, 1.0};
  EXPECT_EQ(air.coefficient_at(100), 0.6);
  EXPECT_NEAR(air.coefficient_at(2 * 340), 1.2, 1e-12);
  EXPECT_EQ(air.coefficient_at(2000), 1.0);
}

TEST(Walls, AMovingWallPushesADeformableBody) {
  RigidWall wall;
  wall.normal = {0, 0, 1}, wall.velocity = {0, 0, 20};
  Model m = make_model(box({0, 0, 0}, {2e-3, 2e-3, 4e-3}, {2, 2, 4}), copper_elastic(), {}, {wall});
  double deepest = 0;
  for (int n = 0; n < 400; ++n) {
    step(m, 0.9 * stable(m));
    for (const Vec3& x : m.state.x) deepest = std::fmin(deepest, x.z - 20 * m.state.t);
  }
  EXPECT_GT(deepest, -1e-12);
  const EnergyRow row = energy_row(m.physics, m.state);
  EXPECT_GT(row.kinetic, 0.4 * 8930 * 1.6e-8 * 400);
  RigidWall still;
  still.normal = {0, 0, 1};
  Model other = make_model(box({0, 0, 0}, {2e-3, 2e-3, 4e-3}, {2, 2, 4}), copper_elastic(),
                           [](const Vec3&) {
                             return Vec3{0, 0, -20};
                           },
                           {still});
  for (int n = 0; n < 400; ++n) step(other, 0.9 * stable(other));
  double off = 0;  // the same seen from the wall
  for (int n = 0; n < m.mesh.node_count(); ++n)
    off = std::fmax(off, norm(m.state.x[NodeId(n)] - other.state.x[NodeId(n)] - Vec3{0, 0, 20 * m.state.t}));
  EXPECT_LT(off, 1e-12);
  EXPECT_NEAR(row.residual, energy_row(other.physics, other.state).residual, 1e-10 * row.kinetic);
}

}  // namespace
}  // namespace bw::csd
