// SPDX-License-Identifier: Apache-2.0
// A crack in the step changes mass, momentum and energy by nothing; a finite-threshold-free run is the run without
// fracture.
#include <gtest/gtest.h>

#include "csd/mesh/cylinder.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

Model expanding(double limit, const FilterCase& filter = {}) {
  Model m = make_model(
      box({0, 0, 0}, {0.04, 0.01, 0.01}, {12, 3, 3}, 0.1), copper_j2(),
      [](const Vec3& X) {
        return Vec3{1.5e4 * (X.x - 0.02), 0, 0};
      },
      {}, {}, filter);
  if (limit > 0) {
    FractureInput input;
    input.criterion.model = EqpsLimit{limit};
    m.physics.cracks.emplace(input, m.mesh, 0.0);
  }
  return m;
}

TEST(Cracks, KeepMassMomentumAndEnergy) {
  for (const char* kind : {"off", "self_adjoint"}) {
    Model m = expanding(0.1, {kind, 0.5});
    double mass0 = 0;
    for (double mass : m.state.m) mass0 += mass;
    int cracked = 0;
    for (int n = 0; n < 400 && cracked < 10; ++n) {
      const double dt = 0.9 * stable(m);
      auto cracks = std::move(m.physics.cracks);
      m.physics.cracks.reset();
      step(m, dt);
      m.physics.cracks = std::move(cracks);
      const EnergyRow before = energy_row(m.physics, m.state);
      Vec3 p0, L0, p1, L1;
      for (int i = 0; i < m.mesh.node_count(); ++i)
        p0 += m.state.m[NodeId(i)] * m.state.v[NodeId(i)],
            L0 += cross(m.state.x[NodeId(i)], m.state.m[NodeId(i)] * m.state.v[NodeId(i)]);
      Vec3 f0, f1;
      for (const Vec3& f : m.state.f) f0 += f;
      if (!m.physics.cracks->advance(m)) continue;
      ++cracked;
      ASSERT_EQ(m.topology.find_fault(m.mesh), "");
      double mass1 = 0;
      for (double mass : m.state.m) mass1 += mass;
      for (int i = 0; i < m.mesh.node_count(); ++i)
        p1 += m.state.m[NodeId(i)] * m.state.v[NodeId(i)],
            L1 += cross(m.state.x[NodeId(i)], m.state.m[NodeId(i)] * m.state.v[NodeId(i)]);
      for (const Vec3& f : m.state.f) f1 += f;
      const EnergyRow after = energy_row(m.physics, m.state);
      EXPECT_NEAR(mass1, mass0, 1e-14 * mass0);
      EXPECT_NEAR(after.kinetic, before.kinetic, 1e-13 * before.kinetic);
      EXPECT_NEAR(after.elastic, before.elastic, 1e-12 * before.elastic);
      EXPECT_NEAR(after.residual, before.residual, 1e-11 * before.kinetic);
      EXPECT_LT(norm(p1 - p0), 1e-13 * mass0 * 300);
      EXPECT_LT(norm(L1 - L0), 1e-13 * mass0 * 300);
      EXPECT_LT(norm(f1 - f0), 1e-8);
    }
    EXPECT_GE(cracked, 3);
    EXPECT_GT(m.physics.cracks->fragments(m).count(), 1);
    for (int n = 0; n < 100; ++n) step(m, 0.9 * stable(m));
    EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 0.01 * m.physics.energy.initial);
  }
}

/// A ring that flies apart: pieces of a width of its own, eq (17).
Model bursting(double limit, bool has_pieces) {
  Tube tube;
  tube.inner_radius = 0.045, tube.outer_radius = 0.05, tube.length = 0.03;
  tube.around = 64, tube.through = 2, tube.along = 8;
  Model m = make_model(tube.make(), copper_j2(), [](const Vec3& X) {
    const double r = std::sqrt(X.x * X.x + X.y * X.y);
    return Vec3{250 * X.x / r, 250 * X.y / r, 0};
  });
  if (limit > 0) {
    FractureInput input;
    input.criterion.model = EqpsLimit{limit};
    if (has_pieces) input.pieces.emplace();
    m.physics.cracks.emplace(input, m.mesh, 0.0);
  }
  return m;
}

TEST(Cracks, PiecesKeepMassMomentumAndEnergy) {
  Model m = bursting(0.05, true);
  double mass0 = 0, kinetic0 = 0;
  for (double mass : m.state.m) mass0 += mass;
  for (int n = 0; n < 400 && m.physics.cracks->pieces()->rows().empty(); ++n) {
    const double dt = 0.9 * stable(m);
    auto cracks = std::move(m.physics.cracks);
    m.physics.cracks.reset();
    step(m, dt);
    m.physics.cracks = std::move(cracks);
    const EnergyRow before = energy_row(m.physics, m.state);
    kinetic0 = before.kinetic;
    if (!m.physics.cracks->advance(m)) continue;
    const EnergyRow after = energy_row(m.physics, m.state);
    EXPECT_NEAR(after.kinetic, before.kinetic, 1e-13 * before.kinetic);
    EXPECT_NEAR(after.elastic, before.elastic, 1e-12 * before.elastic);
    EXPECT_NEAR(after.residual, before.residual, 1e-11 * before.kinetic);
  }
  ASSERT_GT(kinetic0, 0);
  ASSERT_EQ(m.physics.cracks->pieces()->rows().size(), 1u);
  const Row& row = m.physics.cracks->pieces()->rows()[0];
  // the ring's own numbers: flow stress 400 + 0.05 * 100 MPa, density 8930, gamma' 56
  EXPECT_NEAR(row.width, std::sqrt(2 * 405e6 / (8930 * 56)) * row.state.radius / row.state.speed, 0.01 * row.width);
  EXPECT_EQ(m.physics.cracks->fragments(m).count(), row.bins);
  EXPECT_EQ(m.topology.find_fault(m.mesh), "");
  double mass1 = 0;
  for (double mass : m.state.m) mass1 += mass;
  EXPECT_NEAR(mass1, mass0, 1e-14 * mass0);
  for (int n = 0; n < 200; ++n) step(m, 0.9 * stable(m));
  EXPECT_EQ(m.physics.cracks->fragments(m).count(), row.bins);  // pieces stay whole
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual), 0.01 * m.physics.energy.initial);
}

TEST(Cracks, OutOfReachIsTheRunWithout) {  // T21
  Model with = expanding(1e9), without = expanding(0);
  for (int n = 0; n < 100; ++n) step(with, 0.9 * stable(with)), step(without, 0.9 * stable(without));
  EXPECT_EQ(0, memcmp(with.state.x.data(), without.state.x.data(), with.state.x.size() * sizeof(Vec3)));
  Model pieces = bursting(1e9, true), none = bursting(0, false);
  for (int n = 0; n < 50; ++n) step(pieces, 0.9 * stable(pieces)), step(none, 0.9 * stable(none));
  EXPECT_EQ(0, memcmp(pieces.state.x.data(), none.state.x.data(), none.state.x.size() * sizeof(Vec3)));
}

}  // namespace
}  // namespace bw::csd
