// SPDX-License-Identifier: Apache-2.0
// Contact in scenes: a cloud of fragments between walls, a plate that is hit, the lips of cracks.
#include <gtest/gtest.h>

#include <numbers>

#include "contact_scene.h"
#include "csd/fracture/disconnect.h"

namespace bw::csd {
namespace {

RigidWall wall(const Vec3& point, const Vec3& normal, double restitution) {
  RigidWall w;
  w.point = point, w.normal = normal, w.restitution = restitution;
  return w;
}

/// 200 cubes of 4 mm, turned and thrown at random, in a box of 52 mm.
Model cloud(const ContactInput& input, double wall_restitution) {
  std::vector<Mesh> cubes;
  for (int k = 0; k < 200; ++k) {
    const uint64_t i = uint64_t(k);
    Mesh cube = box({-2e-3, -2e-3, -2e-3}, {2e-3, 2e-3, 2e-3}, {2, 2, 2});
    const Mat3 R = rotation({noise(1, i), noise(2, i), noise(3, i)}, 3 * noise(4, i));
    move(cube, R, 8e-3 * Vec3{double(k % 6), double(k / 6 % 6), double(k / 36)});
    cubes.push_back(std::move(cube));
  }
  const int nodes = cubes[0].node_count();
  std::vector<ConditionKind> walls;
  for (int d = 0; d < 3; ++d)
    for (const double side : {-6e-3, 46e-3}) {
      Vec3 point{}, normal{};
      point[d] = side, normal[d] = side < 0 ? 1 : -1;
      walls.push_back(wall(point, normal, wall_restitution));
    }
  Mesh mesh = together(cubes);
  const auto X = mesh.X;
  Model m = make_model(std::move(mesh), copper_elastic(), {}, walls);
  for (int n = 0; n < m.mesh.node_count(); ++n) {
    const uint64_t i = uint64_t(n / nodes);
    const Vec3 spin = 1e4 * Vec3{noise(5, i), noise(6, i), noise(7, i)};
    Vec3 centre;
    for (int a = 0; a < nodes; ++a) centre += (1.0 / nodes) * X[NodeId(int(i) * nodes + a)];
    m.state.v[NodeId(n)] = 100 * Vec3{noise(8, i), noise(9, i), noise(10, i)} + cross(spin, X[NodeId(n)] - centre);
  }
  m.physics.contact.emplace(input);
  make_rigid(m);
  return m;
}

TEST(ContactScenes, CloudOfCubesBetweenWalls) {
  Model m = cloud({.restitution = 0.8, .friction = 0.2}, 1);
  Watch watch(m, 0.05);
  double rise = -1, before = watch.kinetic, deep = 0, crossed = 0, p_error = 0;
  for (int n = 0; n < 3000; ++n) {
    step(m, 2e-7);
    Vec3 impulse;
    for (const auto& w : m.physics.conditions) impulse += std::get<RigidWall>(w).reaction.impulse;
    const Vec3 p = watch.now.p;
    const EnergyRow row = watch.see(m);
    p_error = std::fmax(p_error, norm(watch.now.p - p - impulse) / watch.start.size);
    rise = std::fmax(rise, (row.kinetic - before) / watch.kinetic), before = row.kinetic;
    if (n % 100 == 99) deep = std::fmax(deep, deepest(m)), crossed = std::fmax(crossed, deepest(m, true));
  }
  record("impulses", double(m.physics.contact->impulses())), record("node_depth_over_side", deep / 4e-3);
  record("edge_depth_over_side", crossed / 4e-3);
  record("energy_left", before / watch.kinetic), record("energy_rise", rise);
  record("momentum_off_the_walls_impulse", p_error);
  EXPECT_GT(m.physics.contact->impulses(), 1000);
  EXPECT_LT(p_error, 1e-13);
  EXPECT_LT(rise, 1e-12);
  EXPECT_LT(watch.residual, 1e-11);
  EXPECT_LT(deep, 0.005 * 4e-3);    // 20 um: a step's way
  EXPECT_LT(crossed, 0.15 * 4e-3);  // edges across edges, that no node tells: 0.3 elements
  EXPECT_GT(before, 0.05 * watch.kinetic);
  EXPECT_LT(before, 0.8 * watch.kinetic);
}

/// The same bits whatever the number of threads.
TEST(ContactScenes, CloudOnTwoThreads) {
  const int threads = thread_count();
  Field<Vec3, NodeId> x[2];
  for (int k = 0; k < 2; ++k) {
    set_thread_count(k + 1);
    Model m = cloud({.restitution = 0.8, .friction = 0.2}, 1);
    for (int n = 0; n < 200; ++n) step(m, 2e-7);
    x[k] = m.state.x;
  }
  set_thread_count(threads);
  for (int n = 0; n < int(x[0].size()); ++n) ASSERT_EQ(x[0][NodeId(n)], x[1][NodeId(n)]);
}

/// A fragment, rigid or not, against a plate that flows: momentum passes over, the plate isn't passed through.
TEST(ContactScenes, PlateHitByAFragment) {
  for (const bool is_rigid : {false, true}) {
    Mesh plate = box({-0.03, -0.03, 0}, {0.03, 0.03, 4e-3}, {20, 20, 2});
    Mesh cube = box({-4e-3, -4e-3, -4e-3}, {4e-3, 4e-3, 4e-3}, {4, 4, 4});
    move(cube, rotation({1, 2, 0.5}, 0.6), {1.3e-3, 0.7e-3, 11e-3});
    const int nodes = plate.node_count();
    Mesh mesh = merge({plate, cube}, {"plate", "cube"});
    std::vector<NodeId> of_cube;
    const int elements = plate.elem_count();
    for (int e = 0; e < mesh.elem_count(); ++e) mesh.body[ElemId(e)] = 0;
    Model m = make_model(std::move(mesh), copper_j2(), [](const Vec3& X) {
      return Vec3{0, 0, X.z > 4.001e-3 ? -200.0 : 0.0};
    });
    m.physics.contact.emplace(ContactInput{});
    if (is_rigid) {
      for (int e = 0; e < m.mesh.elem_count(); ++e) m.mesh.body[ElemId(e)] = e >= elements;
      RigidInput input;
      input.bodies = {"cube"};
      m.physics.rigid.emplace(input, std::vector<std::string>{"plate", "cube"}, m.mesh);
      for (int e = 0; e < m.mesh.elem_count(); ++e) m.mesh.body[ElemId(e)] = e >= elements;
      m.physics.rigid->start(m);
      for (int e = 0; e < m.mesh.elem_count(); ++e) m.mesh.body[ElemId(e)] = 0;
    }
    Watch watch(m, 0.03);
    EnergyRow row;
    while (m.state.t < 60e-6) step(m, 0.9 * stable(m)), row = watch.see(m);
    record(is_rigid ? "rigid_residual_over_kinetic" : "residual_over_kinetic", watch.residual);
    double v_cube = 0, m_cube = 0, lowest = 1, under = 1;
    for (int n = 0; n < m.mesh.node_count(); ++n) {
      const NodeId i(n);
      if (n >= nodes)
        v_cube += m.state.m[i] * m.state.v[i].z, m_cube += m.state.m[i], lowest = std::fmin(lowest, m.state.x[i].z);
      if (n < nodes && m.mesh.X[i].z == 0) under = std::fmin(under, m.state.x[i].z);
    }
    EXPECT_GT(v_cube / m_cube, -100);
    EXPECT_GT(lowest, under);
    EXPECT_LT(watch.residual, 5e-3);
    EXPECT_LT(watch.p, 1e-12);
    EXPECT_LT(watch.L, 1e-12);
    EXPECT_LT(watch.rise, 1e-12);
    EXPECT_GT(row.plastic, 0.1 * watch.kinetic);
  }
}

/// Least distance along x of nodes that were one in the plane x = 10 mm: the right one's less the left one's.
double least_gap(const Model& m) {
  double gap = 1;
  const auto is_left = [&](NodeId n) {
    Vec3 c;
    for (NodeId k : m.mesh.hex[m.topology.elements(n)[0]]) c += 0.125 * m.mesh.X[k];
    return c.x < 0.01;
  };
  for (int i = 0; i < m.mesh.node_count(); ++i)
    for (int j = 0; j < m.mesh.node_count(); ++j) {
      const NodeId l(i), r(j);
      if (std::fabs(m.mesh.X[l].x - 0.01) < 1e-9 && m.mesh.X[l] == m.mesh.X[r] && is_left(l) && !is_left(r))
        gap = std::fmin(gap, m.state.x[r].x - m.state.x[l].x);
    }
  return gap;
}

/// A bar that is cut across but for its middle, pressed together: the lips bear as the bar itself would.
TEST(ContactScenes, LipsOfACrackDontPassThroughEachOther) {
  double deep[2], left[3];
  for (const int kind : {0, 1, 2}) {  // cut without contact, with it, not cut
    Mesh mesh = box({0, 0, 0}, {0.02, 0.006, 0.006}, {8, 3, 3});
    Model m = make_model(std::move(mesh), copper_elastic(), [](const Vec3& X) {
      return Vec3{X.x < 0.01 ? 20.0 : X.x > 0.01 ? -20.0 : 0.0, 0, 0};
    });
    std::vector<NodeSplit> splits;
    std::vector<ElemId> changed;
    for (int e = 0; e < m.mesh.elem_count() && kind < 2; ++e) {
      const auto q = m.mesh.nodes_of({ElemId(e), 1});
      Vec3 c;
      for (NodeId n : q) c += 0.25 * m.mesh.X[n];
      if (std::fabs(c.x - 0.01) < 3e-4 && c.y < 4.5e-3)
        detach_face(m.mesh, m.topology, {ElemId(e), 1}, splits, changed);
    }
    m.state.append_copies(splits);
    for (ElemId e : changed) m.physics.elements.blocks.renew(m.mesh, e);
    for (int n = 0; n < m.mesh.node_count(); ++n)
      m.state.m[NodeId(n)] = node_mass(m.mesh, m.physics.elements, m.topology.elements(NodeId(n)), NodeId(n));
    m.physics.time_step.renew();
    if (kind == 1) m.physics.contact.emplace(ContactInput{.bodies = false});
    Watch watch(m, 0.02);
    if (kind < 2) deep[kind] = 0;
    while (m.state.t < 4e-6) {
      step(m, 0.9 * stable(m)), watch.see(m);
      if (kind < 2) deep[kind] = std::fmin(deep[kind], least_gap(m));
    }
    left[kind] = kinetic_energy(m.state) / watch.kinetic;
    EXPECT_LT(watch.p, 1e-12);
    EXPECT_LT(watch.L, 1e-12);
    EXPECT_LT(watch.residual, 2e-3);
    EXPECT_EQ(m.physics.contact && m.physics.contact->impulses() > 0, kind == 1);
    EXPECT_LT(watch.rise, 1e-12);
  }
  EXPECT_NEAR(left[1], left[2], 0.05);  // of the kinetic energy: the pressed bar bears as one that isn't cut
  EXPECT_GT(left[0], 1.3 * left[2]);
  EXPECT_LT(deep[0], -0.01 * 2.5e-3);
  EXPECT_GT(deep[1], -1e-4 * 2.5e-3);
}

}  // namespace
}  // namespace bw::csd
