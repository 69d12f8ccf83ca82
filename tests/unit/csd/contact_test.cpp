// SPDX-License-Identifier: Apache-2.0
// Contact by impulses: momenta exact, energy never gained and always accounted for, nothing passes through.
#include <gtest/gtest.h>

#include "contact_scene.h"
#include "csd/fragments/foot.h"

namespace bw::csd {
namespace {

TEST(Contact, FootOfAPerpendicular) {
  const Mat3 R = rotation({1, 2, -1}, 0.8);
  const auto place = [&](const Vec3& p) { return R * p + Vec3{5, 6, 7}; };
  std::array<Vec3, 4> face{Vec3{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  for (Vec3& p : face) p = place(p);
  const auto foot = foot_on(place({0.5, 0.25, 0.1}), face);
  ASSERT_TRUE(foot);
  EXPECT_NEAR(foot->gap, 0.1, 1e-14);
  EXPECT_NEAR(foot->size, std::sqrt(2.0), 1e-14);
  EXPECT_LT(norm(foot->normal - R * Vec3{0, 0, 1}), 1e-14);
  const double N[4] = {0.75 * 0.75, 0.25 * 0.75, 0.25 * 0.25, 0.75 * 0.25};
  for (size_t a = 0; a < 4; ++a) EXPECT_NEAR(foot->N[a], N[a], 1e-14);
  EXPECT_TRUE(foot_on(place({2, 1, 0}), face));         // a corner is on it
  EXPECT_FALSE(foot_on(place({2.2, 0.5, 0.1}), face));  // beside it
  EXPECT_NEAR(foot_on(place({1, 0.5, -0.2}), face)->gap, -0.2, 1e-14);
  std::array<Vec3, 4> curved = face;
  curved[2] += R * Vec3{0, 0, 0.3};
  const Vec3 x = place({0.9, 0.6, 0.3});
  const auto found = foot_on(x, curved);
  ASSERT_TRUE(found);
  Vec3 p;
  for (size_t a = 0; a < 4; ++a) p += found->N[a] * curved[a];
  EXPECT_LT(norm(x - p - found->gap * found->normal), 1e-13);  // what the angular momentum needs
}

/// Faces of half a millimetre far from the origin: round-off of the coordinates is many times Newton's own.
TEST(Contact, FootFarFromTheOrigin) {
  for (const double far : {0.0, 1.0, 30.0, 1000.0}) {
    const double h = 5e-4;
    const auto place = [&](const Vec3& x) { return Vec3{far + h * x.x, -far + h * x.y, 2 * far + h * (x.z + 0.1 * x.x * x.y)}; };
    const std::array<Vec3, 4> face{place({0, 0, 0}), place({1, 0, 0}), place({1, 1, 0}), place({0, 1, 0})};
    for (const double at : {0.1, 0.37, 0.83}) {
      const auto foot = foot_on(place({at, 0.6, -0.05}), face);
      ASSERT_TRUE(foot) << far << " " << at;
      EXPECT_LT(foot->gap, 0);
      EXPECT_NEAR(foot->gap, -0.05 * h, 0.002 * h + 1e-15 * far);
    }
  }
}

/// Two boxes that fly towards each other along x, the second turned, meshes that don't match.
Model pair_of_boxes(double offset, double turned, const ContactInput& input, bool is_rigid) {
  Mesh a = box({-5e-3, -5e-3, -5e-3}, {5e-3, 5e-3, 5e-3}, {3, 3, 3});
  Mesh b = box({-5e-3, -5e-3, -5e-3}, {5e-3, 5e-3, 5e-3}, {2, 2, 2});
  move(b, rotation({1, 1, 0.3}, turned), {0.0105 + 6e-3 * turned, offset, 0.3 * offset});
  Model m = make_model(together({a, b}), copper_elastic(), [](const Vec3& X) {
    return Vec3{X.x < 0.0051 ? 50.0 : -50.0, 0, 0};
  });
  m.physics.contact.emplace(input);
  if (is_rigid) make_rigid(m);
  return m;
}

TEST(Contact, RigidBoxesHeadOnReverseByTheirRestitution) {
  for (const double e : {0.0, 0.7, 1.0}) {
    Model m = pair_of_boxes(0, 0, {.restitution = e}, true);
    Watch watch(m, 0.01);
    EnergyRow row;
    for (int n = 0; n < 300; ++n) step(m, 1e-7), row = watch.see(m);
    EXPECT_NEAR(m.physics.rigid->bodies()[0].velocity().x, -50 * e, 1e-10);
    EXPECT_NEAR(m.physics.rigid->bodies()[1].velocity().x, 50 * e, 1e-10);
    EXPECT_NEAR(row.kinetic / watch.kinetic, e * e, 1e-12);
    EXPECT_NEAR(row.contact / watch.kinetic, e * e - 1, 1e-12);
    EXPECT_LT(watch.residual, 1e-12);
    EXPECT_LT(watch.p, 1e-13);
    EXPECT_LT(watch.L, 1e-13);
  }
}

/// The approach of the point that hits, reversed by e, costs the square of it.
TEST(Contact, RigidBoxesObliquely) {
  for (const double friction : {0.0, 0.3})
    for (const double offset : {2e-3, 6e-3})
      for (const double turned : {0.2, 0.7}) {
        Model m = pair_of_boxes(offset, turned, {.restitution = 0.7, .friction = friction}, true);
        Watch watch(m, 0.01);
        double deep = 0;
        for (int n = 0; n < 600; ++n) step(m, 1e-7), watch.see(m), deep = std::fmax(deep, deepest(m));
        EXPECT_GT(m.physics.contact->impulses(), 0);
        EXPECT_LT(watch.work, -1e-3);
        EXPECT_LT(watch.residual, 1e-12);
        EXPECT_LT(watch.rise, 1e-14);
        EXPECT_LT(watch.p, 1e-13);
        EXPECT_LT(watch.L, 1e-12) << friction << offset << turned;
        EXPECT_LT(deep, 3e-5);  // of 10 mm; a step's way is 10 um
        EXPECT_GT(fastest_spin(m), 100);
      }
}

TEST(Contact, DeformableBoxes) {
  for (const double offset : {0.0, 4e-3})
    for (const double turned : {0.0, 0.5}) {
      Model m = pair_of_boxes(offset, turned, {}, false);
      Watch watch(m, 0.01);
      EnergyRow row;
      for (int n = 0; n < 700; ++n) step(m, 0.9 * stable(m)), row = watch.see(m);
      EXPECT_GT(m.physics.contact->impulses(), 0);
      EXPECT_LT(watch.p, 1e-12);
      EXPECT_LT(watch.L, 1e-12);
      EXPECT_LT(watch.residual, 1e-3);
      EXPECT_LT(watch.rise, 1e-6);
      EXPECT_LT(watch.work, 0);
    }
}

TEST(Contact, WithoutItTheyPass) {
  Model m = pair_of_boxes(0, 0, {.bodies = false}, true);
  double deep = 0;
  for (int n = 0; n < 1200; ++n) {
    step(m, 1e-7);
    if (n % 100 == 0) deep = std::fmax(deep, deepest(m));
  }
  EXPECT_GT(deep, 3e-3);
  EXPECT_EQ(m.physics.contact->impulses(), 0);
  EXPECT_GT(m.physics.rigid->bodies()[0].centre().x, m.physics.rigid->bodies()[1].centre().x);
  EXPECT_NEAR(m.physics.rigid->bodies()[0].velocity().x, 50, 1e-12);
}

/// How fast the first of two equal bars still is after their impact, over its speed before.
double left_of_speed(int elements, double V) {
  const double L = 0.1;
  const Materials thin = NeoHooke{8930, 117e9, 0.0};  // no waves across
  Mesh a = box({0, 0, 0}, {L, 0.01, 0.01}, {elements, 2, 2}), b = box({0, 0, 0}, {L, 0.01, 0.01}, {elements, 3, 3});
  const double apart = 1e-6;
  move(b, Mat3::identity(), {L + apart, 0, 0});
  const int nodes = a.node_count();
  Model m = make_model(together({a, b}), thin, [&](const Vec3& X) { return Vec3{X.x <= L ? V : 0.0, 0, 0}; });
  m.physics.contact.emplace(ContactInput{});
  Watch watch(m, L);
  const double ends = apart / V + 2 * L / std::sqrt(117e9 / 8930);
  double last = 0;
  for (int64_t before = 0; m.state.t < 1.5 * ends; before = m.physics.contact->impulses()) {
    step(m, 0.9 * stable(m)), watch.see(m);
    if (m.physics.contact->impulses() > before) last = m.state.t;
  }
  double p[2] = {}, mass = 0;
  for (int n = 0; n < m.mesh.node_count(); ++n)
    p[n >= nodes] += m.state.m[NodeId(n)] * m.state.v[NodeId(n)].x, mass += 0.5 * m.state.m[NodeId(n)];
  EXPECT_NEAR(last / ends, 1, 0.08);  // a front is some elements wide
  EXPECT_NEAR((p[0] + p[1]) / mass, V, 1e-12 * V);
  EXPECT_LT(watch.residual, 1e-4);
  EXPECT_LT(watch.p, 1e-13);
  EXPECT_LT(watch.L, 1e-13);
  EXPECT_LE(watch.rise, 1e-15);
  EXPECT_LT(watch.work, -0.2 / elements);  // the layers of nodes that hit, half an element each, lose 0.25
  EXPECT_GT(watch.work, -0.5 / elements);
  return p[0] / mass / V;
}

/// 1-D waves exchange the velocities of equal bars in 2 L/c. What the first keeps is of the order of an element.
TEST(Contact, EqualBarsExchangeTheirVelocities) {
  const double coarse = left_of_speed(40, 10), fine = left_of_speed(80, 10);
  record("left_of_the_speed_40", coarse), record("left_of_the_speed_80", fine);
  EXPECT_LT(coarse, 0.02);
  EXPECT_LT(fine, 0.7 * coarse);
}

/// Both bodies move on, on a support too: work of a support that moves is no energy of the bodies.
TEST(Contact, SupportsBearImpulses) {
  for (const bool moves : {false, true}) {
    Mesh a = box({0, 0, 0}, {0.02, 0.01, 0.01}, {4, 2, 2}), b = box({0, 0, 0}, {0.01, 0.01, 0.01}, {2, 2, 2});
    move(b, Mat3::identity(), {0.0201, 2e-3, 1e-3});
    Mesh mesh = together({a, b});
    for (int n = 0; n < mesh.node_count(); ++n)
      if (mesh.X[NodeId(n)].x > 0.02) mesh.node_sets["wall"].push_back(NodeId(n));
    PrescribedVelocity wall;
    wall.nodes = "wall";
    wall.value = {moves ? -20.0 : 0.0, 0, 0};
    Model m = make_model(mesh, copper_elastic(),
                         [&](const Vec3& X) {
                           return X.x > 0.02 ? wall.value : Vec3{moves ? 0.0 : 20.0, 0, 0};
                         },
                         {wall});
    m.physics.contact.emplace(ContactInput{});
    Watch watch(m, 0.02);
    EnergyRow row;
    for (int n = 0; n < 300; ++n) step(m, 0.9 * stable(m)), row = watch.see(m);
    double p = 0, mass = 0;
    for (int n = 0; n < a.node_count(); ++n)
      p += m.state.m[NodeId(n)] * m.state.v[NodeId(n)].x, mass += m.state.m[NodeId(n)];
    EXPECT_NEAR(p / mass, moves ? -40 : -20, 6);  // bounces by its own stiffness
    EXPECT_LT(watch.residual, 1e-3);
    EXPECT_EQ(row.contact > 0, moves);
  }
}

}  // namespace
}  // namespace bw::csd
