// SPDX-License-Identifier: Apache-2.0
// VALIDATION S13: what one opened face does to the mesh, and which face it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "common/math/random.h"
#include "csd/fracture/disconnect.h"
#include "csd/fracture/fracture.h"
#include "csd/mesh/box.h"
#include "csd/mesh/cylinder.h"
#include "csd/mesh/hex.h"

namespace bw::csd {
namespace {

Mesh box(int nx, int ny, int nz) {
  Box b;
  b.lower = {0, 0, 0};
  b.upper = {double(nx), double(ny), double(nz)};
  b.cells = {nx, ny, nz};
  return b.make();
}
std::span<const Vec3> positions(const Mesh& m) { return {m.X.data(), m.X.size()}; }
int pieces(const Mesh& m) {
  std::vector<int> label(size_t(m.node_count()));
  std::iota(label.begin(), label.end(), 0);
  bool is_changed = true;
  while (is_changed) {
    is_changed = false;
    for (const auto& h : m.hex) {
      int low = label[size_t(h[0].value)];
      for (const NodeId n : h) low = std::min(low, label[size_t(n.value)]);
      for (const NodeId n : h)
        if (label[size_t(n.value)] != low) label[size_t(n.value)] = low, is_changed = true;
    }
  }
  return int(std::set<int>(label.begin(), label.end()).size());
}
std::vector<double> lumped_volume(const Mesh& m) {
  std::vector<double> v(size_t(m.node_count()), 0.0);
  for (const auto& h : m.hex)
    for (const NodeId n : h) v[size_t(n.value)] += hex_volume(corners(h, m.X)).volume / 8;
  return v;
}
int open_nodes(const Mesh& m, const Topology& t, Face f) { return 4 - shared_nodes(m, t, f); }

TEST(FractureTopology, a_TwoHexesPulledApart) {
  Mesh m = box(2, 1, 1);
  Topology t(m);
  Fracture fracture({}, m);
  const auto sigma = [](ElemId) { return Sym3{1e9, 0, 0, 0, 0, 0}; };
  const std::vector<double> fail(2, 1.5);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  EXPECT_TRUE(fracture.advance(m, t, std::vector<Vec3>(m.X.begin(), m.X.end()), sigma, fail, splits, changed));
  EXPECT_EQ(m.node_count(), 16);
  EXPECT_EQ(splits.size(), 4u);
  EXPECT_EQ(pieces(m), 2);
  EXPECT_EQ(changed, std::vector<ElemId>{ElemId(0)});  // both fail alike: the lower id goes first
  for (const NodeSplit& s : splits) {
    EXPECT_EQ(t.elements(s.child).size(), 1u);
    EXPECT_EQ(m.parent[s.child], s.parent);
    EXPECT_EQ(m.node_gid[s.child], s.child.value);
  }
  EXPECT_EQ(t.find_fault(m), "");
  EXPECT_EQ(t.boundary().size(), 12u);
  EXPECT_FALSE(fracture.advance(m, t, std::vector<Vec3>(m.X.begin(), m.X.end()), sigma, fail, splits,
                                changed));  // nothing is joined
  EXPECT_EQ(fracture.waiting(), 0);         // loose elements are no longer looked at
}

TEST(FractureTopology, b_InteriorFaceOfTheCentreElement) {
  Mesh m = box(5, 5, 5);
  Topology t(m);
  const auto volume_before = lumped_volume(m);
  const ElemId e(2 + 5 * 2 + 25 * 2);
  const int side = 1;  // +x, the plane x = 3
  const auto ip = m.nodes_of({e, side});
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  EXPECT_EQ(detach_face(m, t, {e, side}, splits, changed), 4);
  EXPECT_EQ(m.node_count(), 216 + 4);
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(splits[k].parent, ip[k]);
    const auto taken = t.elements(splits[k].child);
    EXPECT_EQ(taken.size(), 4u);
    for (const ElemId owner : taken) EXPECT_LT(centroid(corners(m.hex[owner], m.X)).x, 3);  // e's side of the plane
  }
  int touched = 0;
  for (int z = 0; z < 5; ++z)
    for (int y = 0; y < 5; ++y) {
      const int dy = std::abs(y - 2), dz = std::abs(z - 2), open = open_nodes(m, t, {ElemId(2 + 5 * y + 25 * z), 1});
      const int expected = dy > 1 || dz > 1 ? 0 : dy + dz == 0 ? 4 : dy + dz == 1 ? 2 : 1;
      EXPECT_EQ(open, expected) << y << " " << z;
      touched += open > 0;
    }
  EXPECT_EQ(touched, 9);
  EXPECT_EQ(t.boundary().size(), 150u + 18);
  EXPECT_EQ(t.find_fault(m), "");
  const auto volume = lumped_volume(m);
  const double before = std::accumulate(volume_before.begin(), volume_before.end(), 0.0),
               after = std::accumulate(volume.begin(), volume.end(), 0.0);
  EXPECT_NEAR(after, before, 1e-15 * before);
}

TEST(FractureTopology, c_NothingToSeparateAtABoundaryFace) {
  Mesh m = box(3, 3, 3);
  Topology t(m);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  EXPECT_EQ(detach_face(m, t, {ElemId(0), 0}, splits, changed), 0);
  EXPECT_EQ(m.node_count(), 64);
  // a corner element's inner face: the edge from the corner line inwards is in one element only, which moves alone
  EXPECT_EQ(detach_face(m, t, {ElemId(0), 1}, splits, changed), 4);
  for (const NodeSplit& s : splits)
    EXPECT_EQ(t.elements(s.child).size(), s.parent == NodeId(1) ? 1u : t.elements(s.child).size());
  EXPECT_EQ(t.find_fault(m), "");
  const int again = detach_face(m, t, {ElemId(0), 1}, splits, changed);  // open already
  EXPECT_EQ(again, 0);
}

TEST(FractureTopology, d_MomentaAndEnergyStay) {
  Mesh m = box(4, 4, 4);
  Topology t(m);
  std::vector<Vec3> x(m.X.begin(), m.X.end()), v;
  for (size_t i = 0; i < x.size(); ++i)
    v.push_back({uniform01(1, i, 0) - 0.5, uniform01(1, i, 1) - 0.5, uniform01(1, i, 2)});
  struct Sums {
    Vec3 p, l;
    double energy = 0;
  };
  const auto sums = [&] {
    Sums s;
    const auto mass = lumped_volume(m);
    for (size_t i = 0; i < x.size(); ++i) {
      s.p += mass[i] * v[i];
      s.l += mass[i] * cross(x[i], v[i]);
      s.energy += 0.5 * mass[i] * dot(v[i], v[i]);
    }
    return s;
  };
  const Sums before = sums();
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  for (const int e : {21, 22, 26, 37, 42}) detach_face(m, t, {ElemId(e), e % 6}, splits, changed);
  for (const NodeSplit& s : splits) {
    ASSERT_EQ(size_t(s.child.value), x.size());
    x.push_back(x[size_t(s.parent.value)]);
    v.push_back(v[size_t(s.parent.value)]);
  }
  ASSERT_EQ(int(x.size()), m.node_count());
  const Sums after = sums();
  EXPECT_LT(norm(after.p - before.p), 1e-14 * norm(before.p));
  EXPECT_LT(norm(after.l - before.l), 1e-14 * norm(before.l));
  EXPECT_NEAR(after.energy, before.energy, 1e-14 * before.energy);
  EXPECT_EQ(t.find_fault(m), "");
}

TEST(FractureTopology, e_HoopTensionOpensLongitudinalFaces) {
  Tube tube;
  tube.inner_radius = 0.125;
  tube.outer_radius = 0.137;
  tube.length = 0.05;
  tube.around = 48;
  tube.through = 2;
  tube.along = 3;
  const Mesh m = tube.make();
  const Topology t(m);
  for (int32_t i = 0; i < m.elem_count(); ++i) {
    const Vec3 c = centroid(corners(m.hex[ElemId(i)], m.X)), hoop = unit({-c.y, c.x, 0});
    const Sym3 sigma{1e9 * hoop.x * hoop.x, 1e9 * hoop.y * hoop.y, 0, 1e9 * hoop.x * hoop.y, 0, 0};
    const int side = choose_face(m, t, ElemId(i), positions(m), sigma);
    ASSERT_GE(side, 0);
    EXPECT_GT(std::abs(dot(unit(face_area(m, {ElemId(i), side}, positions(m))), hoop)), 0.99);
    // the opposite face is in the same tension but for rounding: the lower side wins
    EXPECT_EQ(side % 2, 0);
  }
}

TEST(FractureTopology, NothingOpensUnderCompression) {
  Mesh m = box(3, 3, 3);
  Topology t(m);
  Fracture fracture({}, m);
  const auto sigma = [](ElemId) { return Sym3{-1e10, -1e10, -1e9, 0, 0, 0}; };
  const std::vector<double> fail(27, 2.0);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  EXPECT_FALSE(fracture.advance(m, t, positions(m), sigma, fail, splits, changed));
  EXPECT_EQ(fracture.waiting(), 27);
  EXPECT_EQ(m.node_count(), 64);
}

// node positions of each element and which nodes elements share say all about a topology, whatever the numbers of nodes
std::set<std::vector<int>> sharing(const Mesh& m, const Topology& t) {
  std::set<std::vector<int>> groups;
  for (int n = 0; n < m.node_count(); ++n) {
    std::vector<int> group;
    for (const ElemId e : t.elements(NodeId(n))) {
      group.push_back(e);
      group.push_back(int(std::find(m.hex[e].begin(), m.hex[e].end(), NodeId(n)) - m.hex[e].begin()));
    }
    groups.insert(group);
  }
  return groups;
}

TEST(FractureTopology, f_FarApartFailuresCommute) {
  std::vector<std::set<std::vector<int>>> results;
  for (const bool is_swapped : {false, true}) {
    Mesh m = box(9, 5, 5);
    Topology t(m);
    FractureInput input;
    input.is_smoothed = false;
    Fracture fracture(input, m);
    const int a = 1 + 9 * 2 + 45 * 2, b = 7 + 9 * 2 + 45 * 2;
    const auto sigma = [](ElemId) { return Sym3{1e9, 0, 0, 0, 0, 0}; };
    std::vector<double> fail(225, 0.0);
    fail[size_t(a)] = is_swapped ? 1.2 : 1.1;
    fail[size_t(b)] = is_swapped ? 1.1 : 1.2;
    std::vector<NodeSplit> splits;
    std::vector<ElemId> changed;
    const std::vector<Vec3> x(m.X.begin(), m.X.end());
    EXPECT_TRUE(fracture.advance(m, t, x, sigma, fail, splits, changed));
    EXPECT_EQ(splits.size(), 8u);
    results.push_back(sharing(m, t));
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST(FractureTopology, HingesAreSplit) {
  // opening three faces around an edge in turn leaves blocks that touch along it until the clean-up parts them
  Mesh m = box(2, 2, 1);
  Topology t(m);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  for (const Face f : {Face{ElemId(0), 1}, Face{ElemId(3), 0}, Face{ElemId(0), 3}, Face{ElemId(3), 2}}) {
    detach_face(m, t, f, splits, changed);
    EXPECT_EQ(t.find_fault(m), "");
  }
  EXPECT_EQ(m.node_count(), 32);
  EXPECT_EQ(pieces(m), 4);
}

TEST(FractureTopology, FacesOfAnElementCanBeLimited) {
  for (const int limit : {1, 2, 6}) {
    Mesh m = box(1, 1, 5);
    Topology t(m);
    FractureInput input;
    input.faces_per_element = limit;
    input.is_smoothed = false;
    Fracture fracture(input, m);
    std::vector<double> fail(5, 0.0);
    fail[2] = 1.5;
    const auto sigma = [](ElemId) { return Sym3{0, 0, 1e9, 0, 0, 0}; };
    std::vector<NodeSplit> splits;
    std::vector<ElemId> changed;
    for (int step = 0; step < 4; ++step)
      fracture.advance(m, t, std::vector<Vec3>(m.X.begin(), m.X.end()), sigma, fail, splits, changed);
    EXPECT_EQ(fracture.opened(), std::min(limit, 2));
    EXPECT_EQ(pieces(m), 1 + std::min(limit, 2));
  }
}

TEST(FractureTopology, SmoothingIsTheMeanOfNodalMeans) {
  Mesh m = box(2, 1, 1);
  const Topology t(m);
  const std::vector<double> fail{1.0, 3.0};
  Fracture smooth({}, m);
  Mesh grown = m;
  Topology other(grown);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  // four nodes of element 0 see 1, four see (1 + 3) / 2
  smooth.advance(
      grown, other, positions(m), [](ElemId) { return Sym3{}; }, fail, splits, changed);
  EXPECT_DOUBLE_EQ(smooth.selection(m, t, fail, ElemId(0)), 1.5);
  EXPECT_DOUBLE_EQ(smooth.selection(m, t, fail, ElemId(1)), 2.5);
}

TEST(FractureTopology, NodeSetsGrowWithTheirNodes) {
  Mesh m = box(2, 1, 1);
  Topology t(m);
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  detach_face(m, t, {ElemId(0), 1}, splits, changed);
  EXPECT_EQ(m.node_sets.at("z_lower").size(), 8u);
  EXPECT_EQ(m.node_sets.at("x_lower").size(), 4u);
}

}  // namespace
}  // namespace bw::csd
