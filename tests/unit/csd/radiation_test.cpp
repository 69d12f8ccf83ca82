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
  std::vector<RadiatingFace> faces;

  Scene() {
    s.resize(mesh.X.size(), 0);
    s.x = mesh.X;
    s.dt_stable = 1e-6;
    for (size_t n = 0; n < s.m.size(); ++n) s.m[NodeId(int64_t(n))] = 0.01, s.v[NodeId(int64_t(n))] = {3, 7, -2};
    for (const Face f : mesh.face_sets.at("x_upper")) faces.push_back({f, {1, 0, 0}, 400 * 0.05 * 0.05, 1});
  }
};
Vec3 sum_of(const Field<Vec3, NodeId>& f) {
  Vec3 sum;
  for (const Vec3& a : f) sum += a;
  return sum;
}

TEST(Radiation, PlaneWaveOfTheDifference) {
  Scene scene;
  scene.faces[2].impedance = 0;
  Radiation radiation;
  radiation.begin(scene.mesh, scene.s, scene.faces, 0.3);
  Field<Vec3, NodeId> f(scene.mesh.X.size());
  radiation.add(scene.mesh, scene.s, f);
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
  for (RadiatingFace& face : scene.faces) face.impedance = 1e9;
  Radiation radiation;
  radiation.begin(scene.mesh, scene.s, scene.faces, 0.3);
  Field<Vec3, NodeId> f(scene.mesh.X.size());
  radiation.add(scene.mesh, scene.s, f);
  double largest = 0;  // h c/m, from the forces
  for (size_t n = 0; n < f.size(); ++n)
    largest = std::max(largest, -f[NodeId(int64_t(n))].x / (3 - 1) * scene.s.dt_stable / 0.01);
  EXPECT_NEAR(largest, 0.3, 1e-12);
}

TEST(Radiation, ActsAmongTheGivenLoads) {
  Scene scene;
  Loads loads(scene.mesh, {});
  loads.radiation.emplace();
  loads.radiation->begin(scene.mesh, scene.s, scene.faces, 0.3);
  std::vector<std::pair<Face, Vec3>> given;
  for (const RadiatingFace& face : scene.faces) given.push_back({face.face, {8, 0, 0}});
  loads.replace_given(scene.mesh, given, scene.s);
  EXPECT_NEAR(sum_of(scene.s.f).x, 4 * (8 - 2), 1e-12);
  EXPECT_NEAR(loads.power(scene.s), 4 * (8 - 2) * 3, 1e-11);
  loads.radiation.reset();  // what it did is taken back
  loads.replace_given(scene.mesh, given, scene.s);
  EXPECT_NEAR(sum_of(scene.s.f).x, 4 * 8, 1e-12);
}

}  // namespace
}  // namespace bw::csd
