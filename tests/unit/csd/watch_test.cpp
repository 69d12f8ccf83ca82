// SPDX-License-Identifier: Apache-2.0
// Energy and checkerboard are watched: warnings when they should, and the end of a run that loses too much.
#include <gtest/gtest.h>

#include "common/app/error.h"
#include "csd/checkerboard_watch.h"
#include "csd/energy_watch.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

Model thrown_against_a_wall() {
  RigidWall wall;
  wall.normal = {0, 0, 1};
  return make_model(box({0, 0, 0}, {0.01, 0.01, 0.03}, {3, 3, 9}), copper_j2(),
                    [](const Vec3&) {
                      return Vec3{0, 0, -200};
                    },
                    {wall});
}

TEST(EnergyWatch, EndsARunThatLosesTooMuch) {
  Model m = thrown_against_a_wall();
  EnergyWatch watch({0.01, 0.05});
  for (int n = 0; n < 50; ++n) step(m, 0.9 * stable(m));
  EXPECT_NO_THROW(watch.check(energy_row(m.physics, m.state), m));
  EXPECT_LT(watch.worst(), 0.01);
  m.physics.energy.external += 0.04 * m.physics.energy.initial;  // work that was never done
  EXPECT_NO_THROW(watch.check(energy_row(m.physics, m.state), m));
  EXPECT_NEAR(watch.worst(), 0.04, 0.01);
  m.physics.energy.external += 0.04 * m.physics.energy.initial;
  EXPECT_THROW(watch.check(energy_row(m.physics, m.state), m), PhysicsError);
}

TEST(EnergyWatch, RoundOffIsNoEnergy) {
  Model m = thrown_against_a_wall();
  for (Vec3& v : m.state.v) v = {};
  m.physics.energy.initial = 0;
  EnergyRow row = energy_row(m.physics, m.state);
  EnergyWatch watch({0.01, 0.05});
  row.residual = row.elastic = 1e-9;  // of a bar of 3 cm^3 of copper, whose volumes have a round-off of 1e-16
  EXPECT_NO_THROW(watch.check(row, m));
  EXPECT_EQ(watch.worst(), 0);
  row.elastic = 1e-3, row.residual = 4e-5;  // small, but energy
  EXPECT_NO_THROW(watch.check(row, m));
  EXPECT_NEAR(watch.worst(), 0.04, 1e-12);
  row.residual = 1e-4;
  EXPECT_THROW(watch.check(row, m), PhysicsError);
}

TEST(EnergyAudit, FindsTheElementThatLosesIt) {
  Model m = thrown_against_a_wall();
  for (int n = 0; n < 50; ++n) step(m, 0.9 * stable(m));
  EnergyAudit audit(m);
  const double before = energy_row(m.physics, m.state).residual;
  const ElemId thief(40);
  const SlotId slot = m.physics.elements.blocks.slot[thief];
  for (int n = 0; n < 20; ++n) {
    step(m, 0.9 * stable(m));
    m.state.history[0].change(slot / lanes, [&](double* history) {
      for (int i = 0; i < 8; ++i) history[(i * 7 + 6) * lanes + slot % lanes] += 1e-3;  // plastic work that nobody did
    });
    audit.add(m);
  }
  const std::string report = audit.report(m);
  EXPECT_NE(report.find("element 40 of body 0"), std::string::npos) << report;
  const double change = energy_row(m.physics, m.state).residual - before;
  EXPECT_NE(report.find(fmt::format("changed by {:.3g} J", change)), std::string::npos) << report;
  EXPECT_GT(change, 0);
}

TEST(EnergyAudit, IsQuietWhereNothingIsLost) {
  Model m = make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {3, 3, 3}, 0.1), copper_elastic(), [](const Vec3& X) {
    return Vec3{20 * std::sin(30 * X.y), 0, 10 * X.x};
  });
  const double dt = 0.02 * stable(m);
  for (int n = 0; n < 10; ++n) step(m, dt);
  EnergyAudit audit(m);
  const double before = energy_row(m.physics, m.state).residual;
  for (int n = 0; n < 20; ++n) step(m, dt), audit.add(m);
  EXPECT_LT(std::fabs(energy_row(m.physics, m.state).residual - before), 1e-6 * m.physics.energy.initial);
  EXPECT_EQ(audit.steps(), 20);
}

TEST(Energy, ChangesOfTheStepAreBooked) {  // steps of one length conserve; so do steps of many lengths, to second order
  double worst[2];
  for (const bool varies : {false, true}) {
    Model m = make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {3, 3, 3}, 0.1), copper_elastic(), [](const Vec3& X) {
      return Vec3{20 * std::sin(30 * X.y), 0, 10 * X.x};
    });
    const double dt = 0.3 * stable(m);
    worst[varies] = 0;
    for (int n = 0; n < 1000; ++n) {
      step(m, varies && n / 50 % 2 ? 0.6 * dt : dt);
      worst[varies] = std::fmax(worst[varies], std::fabs(energy_row(m.physics, m.state).residual));
    }
    worst[varies] /= m.physics.energy.initial;
  }
  EXPECT_LT(worst[0], 1e-4);
  EXPECT_LT(worst[1], 20 * worst[0] + 1e-6);
}

TEST(CheckerboardWatch, WarnsOnceWhenItGrows) {
  CheckerboardWatch quiet, growing, high;
  int warnings[3] = {};
  for (int n = 0; n < 2000; ++n) {
    warnings[0] += quiet.warns(n < 100 ? 0.9 : 0.12, n);
    warnings[1] += growing.warns(0.1 + 0.0003 * n, n);
    warnings[2] += high.warns(0.7, n);
  }
  EXPECT_EQ(warnings[0], 0);
  EXPECT_EQ(warnings[1], 1);
  EXPECT_EQ(warnings[2], 1);
}

TEST(Filter, GatesActWhereTheyShould) {
  const auto moved = [](const char* gate, bool checkered) {
    FilterCase filter{.kind = "self_adjoint", .strength = 0.5};
    filter.gate = gate;
    Model m = make_model(box({0, 0, 0}, {8, 2, 2}, {8, 2, 2}), copper_elastic(), {}, {}, {}, filter);
    for (int i = 0; i < m.mesh.node_count(); ++i) {
      Vec3& x = m.state.x[NodeId(i)];
      x.x += checkered ? (int(m.mesh.X[NodeId(i)].x + 0.5) % 2 ? 1e-3 : -1e-3) : 2e-4 * x.x * x.x;
    }
    first_forces(m), first_forces(m);
    double change = 0;  // of the mean stress, by the filter
    for (int e = 0; e < m.mesh.elem_count(); ++e) {
      const SlotId slot = m.physics.elements.blocks.slot[ElemId(e)];
      const double raw = copper.volumetric.mean_stress(m.state.volume[slot] / m.state.V0[slot]);
      change = std::fmax(change, std::fabs((*m.physics.filter->mean_stress())[slot] - raw) / std::fabs(raw));
    }
    return change;
  };
  EXPECT_GT(moved("none", true), 0.3);
  EXPECT_GT(moved("checkerboard", true), 0.3);
  EXPECT_EQ(moved("checkerboard", false), 0);  // a smooth field passes
  EXPECT_GT(moved("none", false), 0);
  EXPECT_EQ(moved("plastic", true), 0);  // nothing flows
}

TEST(Filter, GatedEnergyIsConserved) {
  FilterCase filter{.kind = "self_adjoint", .strength = 0.5};
  filter.gate = "checkerboard", filter.threshold = 0.02;
  Model m = make_model(
      box({0, 0, 0}, {0.1, 0.1, 0.1}, {5, 5, 5}, 0.1), copper_elastic(),
      [](const Vec3& X) {
        return Vec3{30 * std::sin(50 * X.y), 20 * std::cos(70 * X.z), 40 * X.x};
      },
      {}, {}, filter);
  const double dt = 0.3 * stable(m);
  for (int n = 0; n < 1000; ++n) step(m, dt);
  const EnergyRow e = energy_row(m.physics, m.state);
  EXPECT_NE(e.filter, 0);
  EXPECT_LT(std::fabs(e.residual), 2e-3 * m.physics.energy.initial);
}

}  // namespace
}  // namespace bw::csd
