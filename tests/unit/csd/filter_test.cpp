// SPDX-License-Identifier: Apache-2.0
// VALIDATION A.4: the pair of averages, and what the filter does to forces and energy.
#include <gtest/gtest.h>

#include "solid_scene.h"

namespace bw::csd {
namespace {

Model squeezed(const FilterCase& filter, int n = 5) {
  Model m = make_model(box({0, 0, 0}, {1, 1, 1}, {n, n, n}, 0.2), copper_elastic(), {}, {}, {}, filter);
  for (int i = 0; i < m.mesh.node_count(); ++i)
    for (int d = 0; d < 3; ++d) m.state.x[NodeId(i)][d] += 0.01 * noise(3, uint64_t(3 * i + d));
  return m;
}

TEST(Filter, ConstantPressureStays) {
  for (const char* kind : {"plain", "self_adjoint"}) {
    Model m = make_model(box({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, 0.2), copper_elastic(), {}, {}, {}, {kind, 0.5});
    for (auto& x : m.state.x) x = 0.97 * x;
    first_forces(m);
    const double J = 0.97 * 0.97 * 0.97, p = 0.5 * copper.volumetric.kappa * (J - 1 / J);
    for (int e = 0; e < m.mesh.elem_count(); ++e)
      EXPECT_NEAR((*m.physics.filter->mean_stress())[m.physics.elements.blocks.slot[ElemId(e)]], p,
                  1e-12 * std::fabs(p));
  }
}

TEST(Filter, KeepsTheIntegralOfPressure) {
  Model m = squeezed({"plain", 0.5});
  first_forces(m);
  double raw = 0, filtered = 0, scale = 0;
  for (int e = 0; e < m.mesh.elem_count(); ++e) {
    const SlotId slot = m.physics.elements.blocks.slot[ElemId(e)];
    const double V = m.state.V0[slot], p = copper.volumetric.mean_stress(m.state.volume[slot] / V);
    raw += V * p, filtered += V * (*m.physics.filter->mean_stress())[slot], scale += V * std::fabs(p);
  }
  EXPECT_NEAR(raw, filtered, 1e-13 * scale);
}

TEST(Filter, SelfAdjointForceIsTheEnergysFiniteDifference) {
  Model m = squeezed({"self_adjoint", 0.5}, 3);
  first_forces(m);
  const Field<Vec3, NodeId> f = m.state.f;
  const auto energy = [&] {
    m.physics.filter->smooth(m.physics.elements, m.state);
    return stored_energy(m.physics.elements, m.state).elastic + m.physics.filter->energy(m.physics.elements, m.state);
  };
  double scale = 0;
  Vec3 sum, moment;
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    scale = std::fmax(scale, norm(f[NodeId(i)]));
    sum += f[NodeId(i)], moment += cross(m.state.x[NodeId(i)], f[NodeId(i)]);
  }
  EXPECT_LT(norm(sum), 1e-12 * scale);
  EXPECT_LT(norm(moment), 1e-12 * scale);
  for (int i = 0; i < m.mesh.node_count(); i += 5) {
    const NodeId n(i);
    for (int d = 0; d < 3; ++d) {
      const double h = 1e-6, x = m.state.x[n][d];
      m.state.x[n][d] = x + h;
      const double up = energy();
      m.state.x[n][d] = x - h;
      const double down = energy();
      m.state.x[n][d] = x;
      EXPECT_NEAR(-(up - down) / (2 * h), f[n][d], 1e-6 * scale);
    }
  }
}

TEST(Filter, EnergyIsConserved) {
  for (const char* kind : {"plain", "self_adjoint"}) {
    const auto velocity = [](const Vec3& X) {
      return Vec3{30 * std::sin(50 * X.y), 20 * std::cos(70 * X.z), 40 * X.x};
    };
    Model m =
        make_model(box({0, 0, 0}, {0.1, 0.1, 0.1}, {5, 5, 5}, 0.1), copper_elastic(), velocity, {}, {}, {kind, 0.5});
    const double dt = 0.3 * stable(m);
    for (int n = 0; n < 1000; ++n) step(m, dt);
    const EnergyRow e = energy_row(m.physics, m.state);
    EXPECT_NE(e.filter, 0);
    EXPECT_LT(std::fabs(e.residual), 2e-3 * m.physics.energy.initial) << kind;
  }
}

TEST(Filter, CheckerboardIsSeen) {  // chi: 0 for a uniform field and at rest, of order 1 for volumes that alternate
  Model m = make_model(box({0, 0, 0}, {8, 1, 1}, {8, 1, 1}), copper_elastic());
  Checkerboard raw;
  const auto chi = [&] {
    first_forces(m);
    return raw.of(m.physics.elements, m.state);
  };
  EXPECT_EQ(chi(), 0);
  for (int i = 0; i < m.mesh.node_count(); ++i) m.state.x[NodeId(i)] = 0.99 * m.mesh.X[NodeId(i)];
  EXPECT_LT(chi(), 1e-9);
  for (int i = 0; i < m.mesh.node_count(); ++i) {
    m.state.x[NodeId(i)] = m.mesh.X[NodeId(i)];
    m.state.x[NodeId(i)].x += int(m.mesh.X[NodeId(i)].x + 0.5) % 2 ? 1e-3 : -1e-3;
  }
  EXPECT_GT(chi(), 0.8);
}

TEST(Filter, PlaneWaveIsNotDamped) {  // S2b with filter: half sine of 20 cells over 80 cells
  for (const char* kind : {"off", "plain", "self_adjoint"}) {
    const Elastic steel(7800, 206e9, 0.3);
    std::vector<ConditionKind> sides;
    for (const auto& [set, normal] : {std::pair{"y_lower", Vec3{0, 1, 0}},
                                      {"y_upper", Vec3{0, 1, 0}},
                                      {"z_lower", Vec3{0, 0, 1}},
                                      {"z_upper", Vec3{0, 0, 1}}}) {
      Roller r;
      r.nodes = set, r.normal = normal;
      sides.emplace_back(r);
    }
    PrescribedVelocity pulse;
    pulse.nodes = "x_lower", pulse.value = {1, 0, 0}, pulse.components = "x";
    Table t;
    const double c = 5962.57, T = 0.2 / c;
    for (int i = 0; i <= 100; ++i) t.times.push_back(T * i / 100), t.values.push_back(std::sin(M_PI * i / 100.0));
    pulse.factor = t;
    sides.emplace_back(pulse);
    Model m = make_model(box({0, 0, 0}, {1, 0.01, 0.01}, {100, 1, 1}), NeoHooke(7800, 206e9, 0.3), {}, sides, {},
                         {kind, 0.5});
    EXPECT_NEAR(steel.sound_speed(), c, 0.01);
    const double end = 0.9 / c;  // the pulse's middle stands at 0.8 m
    while (m.state.t < end) step(m, std::fmin(0.9 * stable(m), end - m.state.t));
    double peak = 0, at = 0, first = 0;
    for (int i = 0; i < m.mesh.node_count(); ++i) {
      const double v = m.state.v[NodeId(i)].x, x = m.mesh.X[NodeId(i)].x;
      if (x > 0.65 && x < 0.95) peak = std::fmax(peak, v), at += v * x, first += v;
    }
    printf("%s: peak %.4f, middle %.5f m\n", kind, peak, at / first);
    EXPECT_GT(peak, 0.985) << kind;
    EXPECT_NEAR(at / first, 0.8, 0.002 * 0.8) << kind;
  }
}

}  // namespace
}  // namespace bw::csd
