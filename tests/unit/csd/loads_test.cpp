// SPDX-License-Identifier: Apache-2.0
// Loads: totals, tables, and the curves of Kingery and Bulmash against published values and their own consistency.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/app/error.h"
#include "csd/fragments/followers.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

Vec3 total(const Mesh& mesh, LoadKind load, double t = 0, double mass = 1) {
  Field<Vec3, NodeId> f(mesh.X.size());
  Field<double, NodeId> m(mesh.X.size(), mass);
  std::visit([&](auto& l) { l.select(mesh), l.add(mesh, mesh.X, m, t, f); }, load);
  Vec3 sum;
  for (const Vec3& a : f) sum += a;
  return sum;
}
void expect_near(const Vec3& a, const Vec3& b, double tolerance) { EXPECT_LT(norm(a - b), tolerance); }

TEST(Loads, TractionByAreaAndByTotal) {
  const Mesh mesh = box({0, 0, 0}, {0.1, 0.2, 0.3}, {3, 4, 5}, 0.2);
  Traction t;
  t.faces = {"x_upper"}, t.traction = {0, 5e5, 0}, t.factor = Table{{0, 1}, {1, 3}};
  expect_near(total(mesh, t), {0, 5e5 * 0.06, 0}, 1e-7);
  expect_near(total(mesh, t, 0.5), {0, 10e5 * 0.06, 0}, 1e-7);
  t.traction = {}, t.total = {1, 2, 3}, t.faces = {"x_upper", "y_lower"}, t.factor.reset();
  expect_near(total(mesh, t), {1, 2, 3}, 1e-12);
}

TEST(Loads, BodyForceOfASet) {
  Mesh mesh = box({0, 0, 0}, {0.1, 0.2, 0.3}, {2, 2, 2}, 0.2);
  BodyForce b;
  b.density = {1e3, 0, 2e3};
  expect_near(total(mesh, b), 0.006 * b.density, 1e-12);
  mesh.elem_sets["one"] = {ElemId(0)};
  b.elements = "one";
  const double V = volume_of(modes_of(corners(mesh, ElemId(0))));
  expect_near(total(mesh, b), V * b.density, 1e-12);
}

TEST(Loads, FrontWithAnyDecay) {
  PressureFront front;
  front.peak = 1e9, front.speed = 1000, front.axis = {1, 0, 0}, front.faces = {"y_lower"};
  front.behind = {0, 0.1, 0.3}, front.factors = {1, 0.5, 0.1};
  Mesh mesh = box({0, 0, 0}, {1, 0.1, 0.1}, {4, 1, 1});
  front.select(mesh);
  EXPECT_EQ(front.pressure({0.6, 0, 0}, 0.5e-3), 0);
  EXPECT_NEAR(front.pressure({0.45, 0, 0}, 0.5e-3), 0.75e9, 1);
  EXPECT_NEAR(front.pressure({0.3, 0, 0}, 0.5e-3), 0.3e9, 1);
  EXPECT_NEAR(front.pressure({0, 0, 0}, 0.5e-3), 0.1e9, 1);
}

/// Forces of a front and of given forces on a cracked box, walked by the loaded nodes alone, against all faces in turn.
TEST(Loads, GoOverLoadedNodesAlone) {
  PressureFront front;
  front.peak = 1e9, front.speed = 1000, front.axis = {1, 0, 0}, front.faces = {"y_lower"}, front.decay = 2;
  Mesh mesh = box({0, 0, 0}, {1, 0.1, 0.5}, {40, 2, 20}, 0.1);
  Topology topology(mesh);
  State s;
  s.resize(mesh.X.size(), 0);
  s.x = mesh.X;
  for (size_t n = 0; n < s.v.size(); ++n) s.v[NodeId(int64_t(n))] = {1.0 + double(n % 7), double(n % 5), -2};
  front.select(mesh);
  Loads loads(mesh, {front});
  int64_t is_loaded = 0;
  for (int32_t n = 0; n < mesh.node_count(); ++n) is_loaded += loads.is_loaded(NodeId(n));
  EXPECT_EQ(is_loaded, 41 * 21);
  const std::vector<Face> loaded = mesh.face_sets.at("y_lower");
  const std::vector<Face> given_faces = mesh.face_sets.at("x_upper");
  std::vector<Vec3> given;
  for (const Face f : given_faces) given.push_back({0, 0, 3e3 + f.elem});
  const auto expected = [&](double t) {
    Field<Vec3, NodeId> f(mesh.X.size());
    for (const Face face : loaded) {
      const auto n = mesh.nodes_of(face);
      const std::array<Vec3, 4> x{s.x[n[0]], s.x[n[1]], s.x[n[2]], s.x[n[3]]};
      if (const double p = front.pressure(centre_of(x), t); p > 0)
        add_pressure(x, p, [&](size_t a) -> Vec3& { return f[n[a]]; });
    }
    for (size_t i = 0; i < given.size(); ++i)
      for (const NodeId n : mesh.nodes_of(given_faces[i])) f[n] += 0.25 * given[i];
    return f;
  };
  const auto expect_all = [&](double t) {
    const Field<Vec3, NodeId> f = expected(t);
    double power = 0, largest = 0;
    for (size_t i = 0; i < f.size(); ++i) {
      const NodeId n{int64_t(i)};
      expect_near(loads.forces()[n], f[n], 1e-9 * front.peak * 1e-3);
      expect_near(s.f[n], f[n], 1e-9 * front.peak * 1e-3);
      power += dot(f[n], s.v[n]), largest = std::max(largest, norm(f[n]));
    }
    EXPECT_GT(largest, 1e3);
    EXPECT_NEAR(loads.power(s), power, 1e-9 * std::abs(power));
  };
  loads.replace_given(mesh, given_faces, given, s);  // at t = 0: no front yet
  expect_all(0);
  s.f = Field<Vec3, NodeId>(mesh.X.size());
  loads.add(mesh, 0.6e-3, s);
  expect_all(0.6e-3);
  std::vector<NodeSplit> splits;  // an element on a loaded edge comes away at one node
  for (const Face f : {mesh.face_sets.at("x_upper").front(), loaded.back()}) {
    const NodeId n = mesh.nodes_of(f)[0];
    const std::vector<ElemId> moved{topology.elements(n).back()};
    if (topology.elements(n).size() > 1) splits.push_back({n, topology.split(mesh, n, moved)});
  }
  ASSERT_FALSE(splits.empty());
  s.append_copies(splits), loads.append_copies(splits);
  s.f = Field<Vec3, NodeId>(mesh.X.size());
  loads.add(mesh, 0.7e-3, s);
  expect_all(0.7e-3);
}

/// What loads leave to a rigid body pushes it as their nodal forces did, and comes back to them.
TEST(Loads, LeaveFacesToRigidBodies) {
  PressureFront front;
  front.peak = 1e9, front.speed = 1000, front.axis = {1, 0, 0}, front.faces = {"y_lower"}, front.decay = 2;
  Pressure pressure;
  pressure.table = {{0, 1}, {1e8, 3e8}}, pressure.faces = {"x_upper"};
  Traction traction;
  traction.traction = {0, 5e5, 0}, traction.faces = {"y_lower"};
  Mesh mesh = box({0, 0, 0}, {1, 0.1, 0.5}, {10, 2, 4}, 0.1);
  Topology topology(mesh);
  std::vector<NodeId> nodes;  // the last layer comes away
  const auto& end = mesh.node_sets.at("x_upper");
  const auto is_last = [&](ElemId e) {
    return std::ranges::any_of(mesh.hex[e], [&](NodeId n) { return std::ranges::count(end, n) > 0; });
  };
  for (int32_t n = 0, whole = mesh.node_count(); n < whole; ++n) {
    std::vector<ElemId> moved;
    const auto around = topology.elements(NodeId(n));
    std::ranges::copy_if(around, std::back_inserter(moved), is_last);
    if (moved.empty()) continue;
    nodes.push_back(moved.size() == around.size() ? NodeId(n) : topology.split(mesh, NodeId(n), moved));
  }
  std::sort(nodes.begin(), nodes.end());
  ASSERT_EQ(topology.find_fault(mesh), "");
  State s;
  s.resize(mesh.X.size(), 0);
  s.x = mesh.X;
  for (double& m : s.m) m = 1;
  Loads loads(mesh, {front, pressure, traction});
  ASSERT_TRUE(loads.are_on_faces());
  EXPECT_FALSE(Loads(mesh, {front, Gravity{}}).are_on_faces());
  loads.add(mesh, 1.5e-3, s);
  const Field<Vec3, NodeId> before = loads.forces();
  std::vector<char> is_rigid(mesh.X.size(), 0);
  std::vector<int32_t> body_at(mesh.X.size(), -1);
  for (const NodeId n : nodes) is_rigid[size_t(n)] = 1, body_at[size_t(n)] = 0;
  std::vector<RigidBody> bodies{{nodes, s.x, s.v, s.m, RigidBody::Motion::six_dof}};
  Followers followers;
  followers.append(bodies, 0, &loads, loads.leave(mesh, is_rigid), body_at);
  EXPECT_TRUE(loads.leave(mesh, is_rigid).empty());
  for (const NodeId n : nodes) loads.forces()[n] = {};
  loads.add(mesh, 1.5e-3, s);
  for (const NodeId n : nodes) EXPECT_EQ(loads.forces()[n], Vec3{});
  followers.take_forces(bodies, &loads);
  RigidBody expected = bodies[0];
  expected.take_forces(before);
  const double size = norm(expected.acceleration_at({}));
  EXPECT_GT(size, 1e5);
  for (const Vec3& arm : {Vec3{}, Vec3{0.3, 0, 0}, Vec3{0, 0.2, 0.1}})
    expect_near(bodies[0].acceleration_at(arm), expected.acceleration_at(arm), 1e-12 * size);
  followers.kick(bodies, 1e-6);
  double power = 0;
  for (size_t i = 0; i < nodes.size(); ++i) power += dot(before[nodes[i]], bodies[0].velocity_at(bodies[0].arm(i)));
  EXPECT_NEAR(followers.power(), power, 1e-12 * power);
  followers.give_back(loads);
  for (size_t n = 0; n < before.size(); ++n)
    expect_near(loads.forces()[NodeId(int64_t(n))], before[NodeId(int64_t(n))], 1e-12 * 1e9);
  loads.leave(mesh, {});
  EXPECT_EQ(loads.leave(mesh, is_rigid).size(), mesh.face_sets.at("x_upper").size() + 2 * 4);
}

TEST(Loads, SameBitsForAnyNumberOfThreads) {
  PressureFront front;
  front.peak = 1e9, front.speed = 1000, front.axis = {1, 0, 0}, front.faces = {"y_lower", "x_lower"}, front.decay = 2;
  Mesh mesh = box({0, 0, 0}, {1, 0.1, 0.5}, {80, 2, 40}, 0.2);
  front.select(mesh);
  const Field<double, NodeId> m(mesh.X.size(), 1.0);
  const int threads = thread_count();
  std::vector<Field<Vec3, NodeId>> forces;
  for (const int count : {1, 2, 3}) {
    set_thread_count(count);
    forces.emplace_back(mesh.X.size());
    front.add(mesh, mesh.X, m, 1e-3, forces.back());
  }
  set_thread_count(threads);
  for (size_t n = 0; n < mesh.X.size(); ++n)
    for (size_t k : {1u, 2u}) ASSERT_TRUE(forces[k][NodeId(int64_t(n))] == forces[0][NodeId(int64_t(n))]) << n;
}

TEST(Blast, TableOfFreeAir) {  // VALIDATION F9: Z, arrival ms, incident, reflected kPa, impulses kPa ms
  const double table[6][6] = {{.5, .1541, 3885, 30360, 141.3, 1454},  {1, .5318, 934.9, 5006, 174.5, 559.0},
                              {2, 1.944, 194.7, 645.8, 92.12, 235.7}, {3, 3.987, 81.59, 215.5, 64.33, 147.1},
                              {5, 8.995, 31.30, 70.02, 40.62, 83.32}, {10, 22.72, 11.09, 23.31, 21.13, 39.71}};
  for (const auto& row : table) {
    const BlastWave w = BlastWave::at(free_air::curves, row[0], 1);
    EXPECT_NEAR(1e3 * w.arrival, row[1], 5e-4 * row[1]);
    EXPECT_NEAR(1e-3 * w.incident, row[2], 5e-4 * row[2]);
    EXPECT_NEAR(1e-3 * w.reflected, row[3], 5e-4 * row[3]);
    // the impulses are those of the pressure histories
    double incident = 0, reflected = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double t = w.arrival + (i + 0.5) / n * w.duration;
      incident += w.pressure(0, t) * w.duration / n, reflected += w.pressure(1, t) * w.duration / n;
    }
    EXPECT_TRUE(w.incident_decay == 0 || std::fabs(incident / row[4] - 1) < 1e-3) << row[0] << " " << incident;
    EXPECT_TRUE(w.reflected_decay == 0 || std::fabs(reflected / row[5] - 1) < 1e-3) << row[0] << " " << reflected;
  }
}

TEST(Blast, ChargesScale) {  // Hopkinson: distance, time and impulse with the cube root of the charge
  const BlastWave one = BlastWave::at(hemisphere::curves, 3, 1), many = BlastWave::at(hemisphere::curves, 30, 1000);
  EXPECT_NEAR(many.incident, one.incident, 1e-9 * one.incident);
  EXPECT_NEAR(many.arrival, 10 * one.arrival, 1e-9);
  EXPECT_NEAR(many.duration, 10 * one.duration, 1e-9);
  EXPECT_NEAR(many.reflected_decay, one.reflected_decay, 1e-9);
}

TEST(Blast, CurvesHangTogether) {  // a wrong digit or sign breaks one of these
  for (const BlastCurves* c : {&free_air::curves, &hemisphere::curves}) {
    for (const auto& ranges : {c->incident_impulse, c->duration})
      for (size_t i = 1; i < ranges.size(); ++i)
        EXPECT_NEAR(ranges[i].at(ranges[i - 1].up_to) / ranges[i - 1].at(ranges[i - 1].up_to), 1, 0.02);
    for (double Z : {2.0, 3.0, 5.0, 10.0, 20.0, 40.0}) {  // plane shock in air of gamma 1.4: reflection
      const double p = blast_value(c->incident, Z), p0 = 101.325;
      EXPECT_NEAR(blast_value(c->reflected, Z) / (2 * p * (7 * p0 + 4 * p) / (7 * p0 + p)), 1, 0.025) << Z;
    }
    for (double Z : {30.0, 40.0}) {  // and its speed: the arrival's slope
      const double p = blast_value(c->incident, Z), h = 0.01;
      const double speed = 2 * h / (blast_value(c->arrival, Z + h) - blast_value(c->arrival, Z - h));
      EXPECT_NEAR(speed, 0.340 * std::sqrt(1 + 6 * p / (7 * 101.325)), 0.03) << Z;
    }
    double before = 1e300;
    for (double Z = c->nearest; Z < 40; Z *= 1.02) {
      EXPECT_LT(blast_value(c->incident, Z), before);
      before = blast_value(c->incident, Z);
      EXPECT_GT(blast_value(c->reflected, Z), 1.99 * before);
    }
  }
}

TEST(Blast, AngleOfIncidence) {
  const BlastWave w = BlastWave::at(free_air::curves, 2, 1);
  const double t = w.arrival * (1 + 1e-9);
  EXPECT_NEAR(w.pressure(1, t), w.reflected, 1e-3 * w.reflected);
  EXPECT_NEAR(w.pressure(0, t), w.incident, 1e-3 * w.incident);
  EXPECT_NEAR(w.pressure(-1, t), w.incident, 1e-3 * w.incident);
  EXPECT_NEAR(w.pressure(0.5, t), w.incident + 0.25 * w.reflected, 1e-3 * w.reflected);
  EXPECT_EQ(w.pressure(1, 0.99 * w.arrival), 0);
  EXPECT_EQ(w.pressure(1, 1.01 * (w.arrival + w.duration)), 0);
}

TEST(Blast, LoadsTheFacesThatItNames) {
  Blast blast;
  blast.centre = {-2, 0.05, 0.05}, blast.charge = 0.5, blast.equivalent = 2, blast.faces = {"x_lower"};
  Mesh mesh = box({0, 0, 0}, {0.1, 0.1, 0.1}, {1, 2, 2});
  const BlastWave w = BlastWave::at(free_air::curves, 2, 1);
  const Vec3 f = total(mesh, blast, 1.0001 * w.arrival + 2e-6);  // the corners are later by 1 us
  EXPECT_NEAR(f.x, 0.01 * w.reflected, 0.02 * 0.01 * w.reflected);
  blast.centre = {-100, 0, 0};
  EXPECT_THROW(blast.select(mesh), InputError);
  blast.centre = {-0.01, 0.05, 0.05};
  EXPECT_THROW(blast.select(mesh), InputError);
}

}  // namespace
}  // namespace bw::csd
