// SPDX-License-Identifier: Apache-2.0
// The wetted surface: closed, stable ids, new connectivity only when cracks have opened.
#include <gtest/gtest.h>

#include <set>

#include "common/app/error.h"
#include "common/math/random.h"
#include "csd/fracture/disconnect.h"
#include "csd/mesh/box.h"
#include "csd/mesh/shell.h"
#include "csd/mesh/surface.h"

namespace bw::csd {
namespace {

Mesh box(int n) {
  Box b;
  b.cells = {n, n, n};
  return b.make();
}
Vec3 sum_of_areas(const coupling::WetSurface& wet) {
  Vec3 sum;
  for (const auto& q : wet.quads) sum += coupling::area_vector(wet.x, q);
  return sum;
}

TEST(MeshSurface, WholeBoundaryIsClosedAndPointsOut) {
  const Mesh m = box(4);
  const Topology t(m);
  Surface s(m, t, {}, "case.toml:1");
  const Field<Vec3, NodeId> v(size_t(m.node_count()), Vec3{1, 2, 3});
  EXPECT_TRUE(s.update(m, t, m.X, v));
  const auto& wet = s.wet();
  EXPECT_EQ(wet.quads.size(), 96u);
  EXPECT_EQ(wet.x.size(), 98u);
  EXPECT_LT(norm(sum_of_areas(wet)), 1e-14);
  for (size_t f = 0; f < wet.quads.size(); ++f) {
    const Vec3 centre = 0.25 * (wet.x[size_t(wet.quads[f][0])] + wet.x[size_t(wet.quads[f][1])] +
                                wet.x[size_t(wet.quads[f][2])] + wet.x[size_t(wet.quads[f][3])]);
    EXPECT_GT(dot(coupling::area_vector(wet.x, wet.quads[f]), centre - Vec3{.5, .5, .5}), 0);
    EXPECT_EQ(wet.flags[f], 0);
  }
  EXPECT_EQ(wet.v[5], (Vec3{1, 2, 3}));
}

TEST(MeshSurface, VersionChangesWithTopologyOnly) {
  Mesh m = box(4);
  Topology t(m);
  Surface s(m, t, {"x_lower"}, "case.toml:1");
  Field<Vec3, NodeId> x = m.X, v(size_t(m.node_count()));
  s.update(m, t, x, v);
  EXPECT_EQ(s.wet().quads.size(), 16u);
  const auto before = s.wet();
  for (Vec3& p : x) p = 2.0 * p;
  EXPECT_FALSE(s.update(m, t, x, v));
  EXPECT_EQ(s.wet().topo_version, before.topo_version);
  EXPECT_EQ(s.wet().x[3], 2.0 * before.x[3]);

  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  detach_face(m, t, {ElemId(21), 1}, splits, changed);
  for (const NodeSplit& split : splits) x.push_back(x[split.parent]), v.push_back(v[split.parent]);
  EXPECT_TRUE(s.update(m, t, x, v));
  const auto& wet = s.wet();
  EXPECT_GT(wet.topo_version, before.topo_version);
  ASSERT_EQ(wet.quads.size(), 16u + t.boundary().size() - 96);  // the lips of the opened face and of those beside it
  for (size_t f = 0; f < 16; ++f) EXPECT_EQ(wet.face_id[f], before.face_id[f]);
  std::set<int64_t> ids(wet.face_id.begin(), wet.face_id.end()), nodes(wet.node_id.begin(), wet.node_id.end());
  EXPECT_EQ(ids.size(), wet.quads.size());
  EXPECT_EQ(nodes.size(), wet.x.size());
  int children = 0;
  for (size_t n = 0; n < wet.x.size(); ++n) {
    if (wet.node_parent[n] < 0) continue;
    ++children;
    EXPECT_TRUE(nodes.count(wet.node_parent[n]));
  }
  EXPECT_EQ(children, int(splits.size()));
  for (size_t f = 16; f < wet.quads.size(); ++f) EXPECT_EQ(wet.flags[f], coupling::face_lip);
}

// T8: uniform pressure on a closed, badly cracked body gives no force, in total nor on any fragment
TEST(MeshSurface, CrackedBodiesStayClosed) {
  Weapon weapon;
  weapon.around = 24;
  Mesh m = weapon.make();
  Topology t(m);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  for (int k = 0; k < 3000; ++k) {
    const ElemId e(int64_t(uniform01(1, uint64_t(k), 0) * m.elem_count()));
    detach_face(m, t, {e, int(uniform01(1, uint64_t(k), 1) * 6)}, splits, changed);
  }
  ASSERT_EQ(t.find_fault(m), "");
  Surface s(m, t, {}, "case.toml:1");
  s.update(m, t, m.X, Field<Vec3, NodeId>(size_t(m.node_count())));
  double area = 0;
  for (const auto& q : s.wet().quads) area += norm(coupling::area_vector(s.wet().x, q));
  EXPECT_LT(norm(sum_of_areas(s.wet())), 1e-14 * area);
  std::vector<Face> faces = s.faces();
  EXPECT_TRUE(is_closed(m, faces));
}

TEST(MeshSurface, ForcesReachTheirNodes) {
  const Mesh m = box(2);
  const Topology t(m);
  Surface s(m, t, {"z_upper"}, "case.toml:1");
  s.update(m, t, m.X, Field<Vec3, NodeId>(27));
  std::vector<Vec3> force(s.wet().x.size());
  for (size_t i = 0; i < force.size(); ++i) force[i] = {0, 0, double(i + 1)};
  Field<Vec3, NodeId> f(27);
  s.add_forces(force, f);
  Vec3 sum;
  for (const Vec3& p : f) sum += p;
  EXPECT_EQ(sum.z, 45);
  for (const NodeId n : m.node_sets.at("z_upper")) EXPECT_GT(f[n].z, 0);
}

TEST(MeshSurface, UnknownSetIsAnInputError) {
  const Mesh m = box(2);
  const Topology t(m);
  try {
    Surface s(m, t, {"outside"}, "case.toml:9");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("case.toml:9"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("x_lower"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace bw::csd
