// SPDX-License-Identifier: Apache-2.0
// Nodes that all ranks follow: those of loads and conditions, and no others.
#include "csd/ranks/needed.h"

#include <numeric>

#include "solid_scene.h"

namespace bw::csd {
namespace {

class Needed : public testing::Test {
 protected:
  Mesh mesh = [] {
    Mesh m = box({0, 0, 0}, {4, 1, 1}, {8, 2, 2});  // 9 x 3 x 3 nodes
    m.elem_sets["one"] = {ElemId(3)};
    return m;
  }();

  int count(const LoadKind& load) { return count({LoadCase{load}}, {}); }
  template <class C>
  int count_of(C condition) {
    condition.select(mesh);
    return count({}, {condition});
  }
  int count(const std::vector<LoadCase>& loads, const std::vector<ConditionKind>& conditions) {
    const std::vector<char> needed = nodes_needed_everywhere(mesh, loads, conditions);
    return std::accumulate(needed.begin(), needed.end(), 0);
  }
};

TEST_F(Needed, LoadsNeedTheirFacesOrElements) {
  Traction traction;
  Pressure pressure;
  Blast blast;
  traction.faces = pressure.faces = {"x_upper"}, blast.faces = {"x_upper", "z_upper"};
  EXPECT_EQ(count(traction), 9);
  EXPECT_EQ(count(pressure), 9);
  EXPECT_EQ(count(blast), 9 + 27 - 3);
  BodyForce force;
  EXPECT_EQ(count(force), 81);
  force.elements = "one";
  EXPECT_EQ(count(force), 8);
  EXPECT_EQ(count(Gravity{}), 81);
}

TEST_F(Needed, ConditionsNeedTheirNodes) {
  Symmetry symmetry;
  symmetry.normal = {0, 0, 1};
  EXPECT_EQ(count_of(symmetry), 27);
  PrescribedDisplacement displacement;
  displacement.nodes = "x_lower", displacement.direction = {1, 0, 0};
  EXPECT_EQ(count_of(displacement), 9);
  Spring spring;
  spring.nodes = "x_lower", spring.stiffness = 1;
  EXPECT_EQ(count_of(spring), 9);
  spring.to = "x_upper";
  EXPECT_EQ(count_of(spring), 18);
  Damping damping;
  EXPECT_EQ(count_of(damping), 81);
  damping.nodes = "x_lower";
  EXPECT_EQ(count_of(damping), 9);
  RigidWall wall;
  wall.normal = {1, 0, 0}, wall.nodes = "x_lower";
  EXPECT_EQ(count_of(wall), 81);  // the momenta of bodies
  wall.separation = "node";
  EXPECT_EQ(count_of(wall), 9);
}

}  // namespace
}  // namespace bw::csd
