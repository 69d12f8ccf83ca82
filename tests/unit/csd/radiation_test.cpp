// SPDX-License-Identifier: Apache-2.0
// Radiation: its forces, the books of impulse and work, and the bound that keeps steps stable.
#include <gtest/gtest.h>

#include "csd/load/loads.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

struct Scene {
  Mesh mesh = box({0, 0, 0}, {0.1, 0.1, 0.1}, {1, 2, 2});
  State s;
  RadiatingFaces faces;

  Scene() {
    s.resize(mesh.X.size(), 0);
    s.x = mesh.X;
    s.dt_stable = 1e-6;
    for (size_t n = 0; n < s.m.size(); ++n) s.m[NodeId(int64_t(n))] = 0.01, s.v[NodeId(int64_t(n))] = {3, 7, -2};
    faces.face = mesh.face_sets.at("x_upper");
    faces.n.assign(faces.size(), {1, 0, 0}), faces.told.assign(faces.size(), 1);
    faces.impedance.assign(faces.size(), 400 * 0.05 * 0.05);
  }
};
Vec3 sum_of(const Field<Vec3, NodeId>& f) {
  Vec3 sum;
  for (const Vec3& a : f) sum += a;
  return sum;
}

TEST(Radiation, PlaneWaveOfTheDifference) {
  Scene scene;
  scene.faces.impedance[2] = 0;
  Radiation radiation;
  radiation.begin(scene.mesh, scene.s, scene.faces, 0.3);
  Field<Vec3, NodeId> f(scene.mesh.X.size());
  radiation.add(scene.mesh, scene.s, f, 0);
  EXPECT_NEAR(sum_of(f).x, -3 * 400 * 0.0025 * (3 - 1), 1e-12);
  EXPECT_EQ(sum_of(f).y, 0);
  radiation.book(scene.mesh, scene.s, 2e-6);
  radiation.book(scene.mesh, scene.s, 1e-6);
  ASSERT_EQ(radiation.impulses().size(), 4u);
  EXPECT_NEAR(radiation.impulses()[0].x, -2 * 3e-6, 1e-18);
  EXPECT_EQ(radiation.impulses()[2].x, 0);
  EXPECT_NEAR(radiation.work(), -3 * 2 * 3e-6 * 3, 1e-17);
}

TEST(Radiation, DenseGasBeforeLightNodesIsHeldBack) {
  Scene scene;
  scene.faces.impedance.assign(scene.faces.size(), 1e9);
  Radiation radiation;
  radiation.begin(scene.mesh, scene.s, scene.faces, 0.3);
  Field<Vec3, NodeId> f(scene.mesh.X.size());
  radiation.add(scene.mesh, scene.s, f, 0);
  double largest = 0;  // h c/m, from the forces
  for (size_t n = 0; n < f.size(); ++n)
    largest = std::max(largest, -f[NodeId(int64_t(n))].x / (3 - 1) * scene.s.dt_stable / 0.01);
  EXPECT_NEAR(largest, 0.3, 1e-12);
}

/// The largest h c/m of a node, from the forces.
double strongest(const Scene& scene, const Field<Vec3, NodeId>& f) {
  double largest = 0;
  for (size_t n = 0; n < f.size(); ++n)
    largest = std::max(largest, -f[NodeId(int64_t(n))].x / (3 - 1) * scene.s.dt_stable / scene.s.m[NodeId(int64_t(n))]);
  return largest;
}

TEST(Radiation, LighterChildrenAndLongerStepsAreHeldBackWithinAWindow) {
  Scene scene;
  scene.faces.impedance.assign(scene.faces.size(), 60 / 1e-6 * 0.01);
  Topology topology(scene.mesh);
  Radiation radiation;
  radiation.begin(scene.mesh, scene.s, scene.faces, 0.3);
  const Face cut = scene.faces.face[0];
  NodeId middle;  // of all four faces
  for (const NodeId n : scene.mesh.nodes_of(cut))
    if (topology.elements(n).size() == 4) middle = n;
  const std::vector<ElemId> elems{cut.elem};
  const NodeSplit split{middle, topology.split(scene.mesh, middle, elems)};
  scene.s.append_copies(std::span(&split, 1));
  scene.s.m[split.child] = 1e-4, scene.s.m[split.parent] = 0.01 - 1e-4;
  Field<Vec3, NodeId> f(scene.mesh.X.size());
  radiation.add(scene.mesh, scene.s, f, 0);
  EXPECT_NEAR(strongest(scene, f), 0.3, 1e-12);
  scene.s.dt_stable = 2e-6;
  f = Field<Vec3, NodeId>(f.size());
  radiation.add(scene.mesh, scene.s, f, 0);
  EXPECT_NEAR(strongest(scene, f), 0.3, 1e-12);
  radiation.book(scene.mesh, scene.s, 1e-6);
  double given = 0;
  for (const Vec3& impulse : radiation.impulses()) given += impulse.x;
  EXPECT_NEAR(given, sum_of(f).x * 1e-6, 1e-12 * std::fabs(given));
}

TEST(Radiation, ThreadsDontChangeBits) {
  const Mesh mesh = box({0, 0, 0}, {0.1, 0.1, 0.1}, {1, 40, 40});
  State s;
  s.resize(mesh.X.size(), 0);
  s.x = mesh.X, s.dt_stable = 1e-6;
  RadiatingFaces faces;
  faces.face = mesh.face_sets.at("x_upper");
  faces.n.assign(faces.size(), {0.6, 0.8, 0}), faces.told.assign(faces.size(), 1);
  for (const Face f : faces.face) faces.impedance.push_back(1 + 0.01 * f.elem.value);
  for (size_t n = 0; n < s.m.size(); ++n)
    s.m[NodeId(int64_t(n))] = 1e-6 * double(1 + n % 7), s.v[NodeId(int64_t(n))] = {0.1 * double(n % 13), 0.3, 1};
  std::vector<Field<Vec3, NodeId>> f;
  std::vector<Vec3> impulse;
  std::vector<double> work;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    Radiation radiation;
    radiation.begin(mesh, s, faces, 0.3);
    f.emplace_back(mesh.X.size());
    radiation.add(mesh, s, f.back(), 0);
    radiation.book(mesh, s, 1e-6);
    Vec3 sum;
    for (const Vec3& one : radiation.impulses()) sum += one;
    impulse.push_back(sum), work.push_back(radiation.work());
  }
  set_thread_count(1);
  EXPECT_TRUE(std::equal(f[0].begin(), f[0].end(), f[1].begin()));
  EXPECT_EQ(impulse[0], impulse[1]);
  EXPECT_EQ(work[0], work[1]);
  EXPECT_NE(sum_of(f[0]).x, 0);
}

TEST(Radiation, ActsAmongTheGivenLoads) {
  Scene scene;
  Loads loads(scene.mesh, {});
  loads.radiation.emplace();
  loads.radiation->begin(scene.mesh, scene.s, scene.faces, 0.3);
  const std::vector<Vec3> given(scene.faces.size(), {8, 0, 0});
  loads.replace_given(scene.mesh, scene.faces.face, given, scene.s);
  EXPECT_NEAR(sum_of(scene.s.f).x, 4 * (8 - 2), 1e-12);
  EXPECT_NEAR(loads.power(scene.s), 4 * (8 - 2) * 3, 1e-11);
  loads.radiation.reset();  // what it did is taken back
  loads.replace_given(scene.mesh, scene.faces.face, given, scene.s);
  EXPECT_NEAR(sum_of(scene.s.f).x, 4 * 8, 1e-12);
}

}  // namespace
}  // namespace bw::csd
