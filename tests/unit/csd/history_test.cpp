// SPDX-License-Identifier: Apache-2.0
// What points remember: read at one point only where all agree, passed over where nothing flows, rounded if asked.
#include <gtest/gtest.h>

#include <cstring>

#include "solid_scene.h"

namespace bw::csd {
namespace {

Materials johnson_cook() {
  const JohnsonCook law{.A = 90e6, .B = 292e6, .n = 0.31, .C = 0.025, .m = 1.09, .T_melt = 1356};
  return RateJ2<JohnsonCook>(copper, law, {.specific_heat = 383});
}

/// A bar that hits a wall: its foot flows, its other end has not been reached by plastic strain.
Model hit(const Materials& material, bool skip, bool single) {
  RigidWall wall;
  wall.normal = {0, 0, 1};
  Mesh mesh = box({0, 0, 0}, {0.01, 0.01, 0.06}, {4, 4, 24});
  Elements el;
  el.blocks = make_blocks(mesh, 1);
  el.materials.push_back(material);
  el.skip_elastic = skip, el.single_history = single;
  State s;
  start(mesh, el, s);
  Physics ph;
  ph.elements = std::move(el);
  ph.conditions.push_back(wall);
  for (auto& c : ph.conditions) std::visit([&](auto& condition) { condition.select(mesh); }, c);
  for (int n = 0; n < mesh.node_count(); ++n) s.v[NodeId(n)] = {0, 0, -150};
  Topology topology(mesh);
  Model m{std::move(mesh), std::move(topology), std::move(s), std::move(ph)};
  first_forces(m);
  for (int n = 0; n < 60; ++n) step(m, 1.5e-7);
  return m;
}
int uniform_blocks(const Model& m) {
  int count = 0;
  for (int b = 0; b < m.physics.elements.blocks.block_count(); ++b) count += m.state.history[0].is_uniform(b);
  return count;
}

TEST(PointHistory, WorkThatOnlyFlowNeedsIsPassedOverAndNothingChanges) {
  for (const Materials& material : {Materials(copper_j2()), johnson_cook()}) {
    const Model all = hit(material, false, false), some = hit(material, true, false);
    const size_t bytes = all.state.x.size() * sizeof(Vec3);
    EXPECT_EQ(0, memcmp(all.state.x.data(), some.state.x.data(), bytes));
    EXPECT_EQ(0, memcmp(all.state.v.data(), some.state.v.data(), bytes));
    EXPECT_EQ(uniform_blocks(all), 0);  // each has been through the return mapping
    EXPECT_GT(uniform_blocks(some), 4);
    EXPECT_LT(uniform_blocks(some), 44);
  }
}

TEST(PointHistory, SinglePrecisionIsNearDouble) {
  const Model a = hit(copper_j2(), true, false), b = hit(copper_j2(), true, true);
  double change = 0, travel = 0;
  for (int i = 0; i < a.mesh.node_count(); ++i) {
    change = std::fmax(change, norm(a.state.x[NodeId(i)] - b.state.x[NodeId(i)]));
    travel = std::fmax(travel, norm(a.state.x[NodeId(i)] - a.mesh.X[NodeId(i)]));
  }
  EXPECT_GT(change, 0);
  EXPECT_LT(change, 1e-6 * travel);
}

TEST(PointHistory, OnlyParallelepipedsAreUniform) {
  Mesh mesh = box({0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  mesh.X[NodeId(62)] += Vec3{0.02, 0, 0};  // an inner node
  Elements el;
  el.blocks = make_blocks(mesh, 1);
  el.materials.push_back(copper_j2());
  State s;
  start(mesh, el, s);
  int uniform = 0, blocks = el.blocks.block_count();
  for (int b = 0; b < blocks; ++b) uniform += s.history[0].is_uniform(b);
  EXPECT_LT(uniform, blocks);
  const auto is_around = [&](int block) {
    for (int l = 0; l < lanes; ++l)
      for (const NodeId n : mesh.hex[el.blocks.elem[SlotId(block * lanes + l)]])
        if (n == NodeId(62)) return true;
    return false;
  };
  for (int b = 0; b < blocks; ++b) EXPECT_EQ(s.history[0].is_uniform(b), !is_around(b));
}

}  // namespace
}  // namespace bw::csd
