// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/io/hdf5.h"
#include "csd/fracture/disconnect.h"
#include "csd/fragments/fragments.h"
#include "csd/mesh/box.h"
#include "csd/mesh/hex.h"
#include "csd/mesh/input.h"

namespace bw::csd {
namespace {

Mesh bar(int n) {
  Box b;
  b.upper = {double(n), 1, 1};
  b.cells = {n, 1, 1};
  return b.make();
}
void cut(Mesh& m, Topology& t, int e) {
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  detach_face(m, t, {ElemId(e), 1}, splits, changed);
}

TEST(Fragments, IdsBirthsAndParents) {
  Mesh m = bar(6);
  Topology t(m);
  Fragments f(m, 0);
  EXPECT_EQ(f.count(), 1);
  cut(m, t, 1);
  EXPECT_TRUE(f.relabel(m, 1e-6));  // 0 1 | 2 3 4 5: the larger part stays fragment 0
  EXPECT_EQ(f.count(), 2);
  EXPECT_EQ(f.id(f.label()[ElemId(5)]), 0);
  EXPECT_EQ(f.id(f.label()[ElemId(0)]), 1);
  EXPECT_FALSE(f.relabel(m, 2e-6));
  cut(m, t, 0);  // of two equal parts the one with the lowest element keeps the id
  cut(m, t, 3);
  EXPECT_TRUE(f.relabel(m, 3e-6));
  EXPECT_EQ(f.count(), 4);
  EXPECT_EQ(f.id(f.label()[ElemId(0)]), 1);
  EXPECT_EQ(f.id(f.label()[ElemId(1)]), 2);
  EXPECT_EQ(f.id(f.label()[ElemId(3)]), 0);
  EXPECT_EQ(f.id(f.label()[ElemId(4)]), 3);
  const Field<double, NodeId> mass(size_t(m.node_count()), 1.0);
  const auto rows = f.table(m, t, {m.X, m.X, mass, std::vector<double>(6, 0.25)});
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].parent, -1);
  EXPECT_EQ(rows[2].parent, 1);
  EXPECT_EQ(rows[3].parent, 0);
  EXPECT_EQ(rows[1].birth, 1e-6);
  EXPECT_EQ(rows[3].birth, 3e-6);
  EXPECT_EQ(rows[3].elements, 2);
  EXPECT_NEAR(rows[3].volume, 2, 1e-14);
  EXPECT_DOUBLE_EQ(rows[3].eqps, 0.25);
}

TEST(Fragments, MomentaOfASpinningPiece) {
  Mesh m = bar(4);
  Topology t(m);
  cut(m, t, 1);
  Fragments f(m, 0);
  const Vec3 spin{10, -20, 30}, drift{100, 0, 5};
  Field<Vec3, NodeId> v(size_t(m.node_count()));
  Field<double, NodeId> mass(size_t(m.node_count()), 0.0);
  for (const auto& h : m.hex)
    for (const NodeId n : h) mass[n] += 7800 * hex_volume(corners(h, m.X)).volume / 8;
  for (int n = 0; n < m.node_count(); ++n) v[NodeId(n)] = drift + cross(spin, m.X[NodeId(n)] - Vec3{1, 0.5, 0.5});
  const auto rows = f.table(m, t, {m.X, v, mass, std::vector<double>(4, 0.0)});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NEAR(rows[0].mass, 2 * 7800, 1e-9);
  EXPECT_LT(norm(rows[0].centroid - Vec3{1, .5, .5}), 1e-14);
  EXPECT_LT(norm(rows[0].velocity - drift), 1e-12);
  EXPECT_LT(norm(rows[0].spin - spin), 1e-12);
  EXPECT_LT(norm(rows[1].spin - spin), 1e-11);
  double total = 0;
  for (const Fragment& row : rows) total += row.kinetic_energy;
  double exact = 0;
  for (int n = 0; n < m.node_count(); ++n) exact += 0.5 * mass[NodeId(n)] * dot(v[NodeId(n)], v[NodeId(n)]);
  EXPECT_NEAR(total, exact, 1e-12 * exact);
  EXPECT_EQ(rows[0].lower.x, 0);
  EXPECT_EQ(rows[0].upper.x, 2);
}

TEST(Fragments, ShapeOfAPieceHoweverItLies) {
  Mesh m = bar(6);
  Topology t(m);
  cut(m, t, 3);
  Fragments f(m, 0);
  const Vec3 axis = unit({1, 2, 3});
  Field<Vec3, NodeId> x = m.X;
  for (Vec3& p : x) {  // half a turn about an axis, moved and stretched to 1 x 2 x 1.5
    const Vec3 q{p.x, 2 * p.y, 1.5 * p.z};
    p = Vec3{100, -50, 7} + 2 * dot(axis, q) * axis - q;
  }
  Field<double, NodeId> mass(size_t(m.node_count()), 0.5);
  const auto rows = f.table(m, t, {x, x, mass, std::vector<double>(6, 0.0), std::vector<double>(6, 300.0)});
  EXPECT_LT(norm(rows[0].sides - Vec3{4, 2, 1.5}), 1e-10);
  EXPECT_LT(norm(rows[1].sides - Vec3{2, 2, 1.5}), 1e-10);
  EXPECT_NEAR(rows[0].surface, 2 * (4 * 2 + 4 * 1.5 + 2 * 1.5), 1e-11);
  EXPECT_NEAR(rows[1].shape_factor(), 0.25 * 2 * (2 * 2 + 2 * 1.5 + 2 * 1.5) / std::pow(6, 2. / 3), 1e-11);
  EXPECT_DOUBLE_EQ(rows[0].temperature, 300);
}

TEST(Fragments, BodiesAreFragmentsFromTheStart) {
  const Mesh m = merge({bar(2), bar(3)}, {"a", "b"});
  const Fragments f(m, 0);
  EXPECT_EQ(f.count(), 2);
  EXPECT_EQ(f.label()[ElemId(4)], 1);
}

TEST(Fragments, FileHasOneRowEach) {
  Mesh m = bar(2);
  Topology t(m);
  Fragments f(m, 0);
  cut(m, t, 0);
  f.relabel(m, 1e-6);
  const Field<double, NodeId> mass(size_t(m.node_count()), 1.0);
  const auto path = (std::filesystem::temp_directory_path() / "breakwave_fragments").string();
  write_fragments(path, 2e-6, f.table(m, t, {m.X, m.X, mass, std::vector<double>(2, 0.0)}));
  std::ifstream in(path + ".csv");
  std::string header, row;
  std::getline(in, header);
  EXPECT_EQ(header.substr(0, 14), "t [s],id [1],p");
  int rows = 0;
  while (std::getline(in, row)) {
    EXPECT_EQ(std::count(row.begin(), row.end(), ','), std::count(header.begin(), header.end(), ','));
    ++rows;
  }
  EXPECT_EQ(rows, 2);
  const h5::File file = h5::File::open(path + ".h5");
  const h5::Group group = file.root().group("fragments");
  EXPECT_EQ(group.read<int64_t>("id"), (std::vector<int64_t>{0, 1}));
  EXPECT_EQ(group.read<double>("surface"), (std::vector<double>{6, 6}));
  EXPECT_EQ(group.read_text_attribute("mass unit"), "kg");
  EXPECT_EQ(group.read_attribute<double>("t"), std::vector<double>{2e-6});
  for (const char* ending : {".csv", ".h5"}) std::filesystem::remove(path + ending);
}

}  // namespace
}  // namespace bw::csd
