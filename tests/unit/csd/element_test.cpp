// SPDX-License-Identifier: Apache-2.0
// VALIDATION A.3, S1, S5: the element's forces.
#include <gtest/gtest.h>

#include "solid_scene.h"

namespace bw::csd {
namespace {

double largest_force(const Corners<double>& f) {
  double m = 0;
  for (const Vec3& v : f.a) m = std::fmax(m, norm(v));
  return m;
}
TEST(Hex, VolumeAndMasses) {
  const Corners<double> x = random_hex(3, 0.15);
  const Columns<double> g = columns_of(modes_of(x));
  double sum = 0, masses = 0;
  for (int i = 0; i < 8; ++i) sum += triple(g.at(0, i), g.at(1, i), g.at(2, i));
  for (double m : row_sums(x)) {
    EXPECT_GT(m, 0);
    masses += m;
  }
  EXPECT_NEAR(volume_of(modes_of(x)), sum, 1e-14);
  EXPECT_NEAR(masses, sum, 1e-14);
}

TEST(A3, ForceIsTheEnergysFiniteDifference) {
  OneElement<J2<LinearFlow>> e(copper_j2(), random_hex(11, 0.15));
  for (int n = 1; n <= 20; ++n) e.force(shaken(e.X, 5, 0.005 * n));  // flows plastically: a history to be kept
  const Corners<double> x = shaken(e.X, 5, 0.0999);                  // a little back: elastic
  const Aligned<double> before = e.history;
  const auto f = e.force(x).f;
  ASSERT_EQ(before, e.history);
  ASSERT_GT(e.eqps(0), 0);
  const double h = 1e-6, scale = largest_force(f);
  double worst = 0;
  for (int a = 0; a < 8; ++a)
    for (int d = 0; d < 3; ++d) {
      Corners<double> up = x, down = x;
      up.a[a][d] += h, down.a[a][d] -= h;
      worst = std::fmax(worst, std::fabs(-(e.energy(up) - e.energy(down)) / (2 * h) - f.a[a][d]) / scale);
    }
  EXPECT_LT(worst, 1e-7);
  record("relative_error", worst);
}

TEST(A3, ForcesAndMomentsSumToNothing) {
  double worst = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    OneElement<J2<LinearFlow>> e(copper_j2(), random_hex(seed, 0.15));
    const Corners<double> x = shaken(e.X, seed + 100, 0.1);
    const auto f = e.force(x).f;
    Vec3 force, moment;
    for (int a = 0; a < 8; ++a) force += f.a[a], moment += cross(x.a[a], f.a[a]);
    EXPECT_LT(norm(force), 1e-13 * 8 * largest_force(f));
    EXPECT_LT(norm(moment), 1e-13 * 8 * largest_force(f));
    worst = std::fmax(worst, std::fmax(norm(force), norm(moment)) / largest_force(f));
  }
  record("sum_over_largest", worst);
}

TEST(S1, PatchTest) {  // (a), (d): affine boundary motion; interior nodes of a perturbed block are in equilibrium there
  const Mat3 F{{{1.1, 0.05, 0}, {0, 0.97, 0.02}, {0.01, 0, 1.04}}};
  double worst_force = 0, worst_stress = 0;
  for (const bool split : {false, true})
    for (const double perturbation : {0.0, 0.15, 0.2}) {
      if (split && perturbation > 0.15) continue;
      Model m = make_model(box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, perturbation, split), copper_elastic());
      for (int n = 0; n < m.mesh.node_count(); ++n) m.state.x[NodeId(n)] = F * m.mesh.X[NodeId(n)];
      first_forces(m);
      std::vector<char> outside(size_t(m.mesh.node_count()), 0);
      for (Face f : m.topology.boundary())
        for (NodeId n : m.mesh.nodes_of(f)) outside[size_t(n)] = 1;
      double inside_force = 0, scale = 0;
      int inside = 0;
      for (int n = 0; n < m.mesh.node_count(); ++n) {
        const double f = norm(m.state.f[NodeId(n)]);
        scale = std::fmax(scale, f);
        if (!outside[size_t(n)]) inside_force = std::fmax(inside_force, f), ++inside;
      }
      EXPECT_GE(inside, 1);
      EXPECT_LT(inside_force, 1e-12 * scale);
      worst_force = std::fmax(worst_force, inside_force / scale);
      const double J = det(F), iso = std::pow(J, -2.0 / 3);
      Mat3 b = F * transpose(F);
      const Sym3 bs{b(0, 0), b(1, 1), b(2, 2), b(0, 1), b(0, 2), b(1, 2)};
      const double p = 0.5 * copper.volumetric.kappa * (J - 1 / J);
      const Sym3 expected = (copper.mu * iso / J) * deviator(bs) + Sym3{p, p, p, 0, 0, 0};
      for (int e = 0; e < m.mesh.elem_count(); ++e) {
        const Sym3 sigma = evaluate(m.physics.elements, m.state, m.physics.elements.blocks.slot[ElemId(e)]).sigma;
        EXPECT_LT(largest(full(sigma - expected)), 1e-12 * copper.volumetric.kappa);
        worst_stress = std::fmax(worst_stress, largest(full(sigma - expected)) / copper.volumetric.kappa);
      }
    }
  record("force_inside", worst_force);
  record("stress_error_over_kappa", worst_stress);
}

TEST(S1, RotationOfAStretchedElement) {  // (b)
  Mat3 U = Mat3::identity();
  U(0, 0) = 1.1;
  J2<LinearFlow> strong(copper, LinearFlow{1e15, 0});
  OneElement<J2<LinearFlow>> e(strong, random_hex(2, 0.1));
  const auto stretched = mapped(e.X, [&](const Vec3& X) { return U * X; });
  e.force(stretched);
  const Mat3 sigma0 = full(e.cauchy(stretched, 4));
  double worst = 0;
  for (int n = 1; n <= 1000; ++n) {
    const Mat3 R = rotation({1, 2, 3}, 4 * M_PI * n / 1000);
    const auto x = mapped(stretched, [&](const Vec3& y) { return R * y; });
    e.force(x);
    worst = std::fmax(worst, largest(full(e.cauchy(x, 4)) - R * sigma0 * transpose(R)));
  }
  EXPECT_LT(worst, 1e-11 * copper.mu);
  record("stress_error_over_mu", worst / copper.mu);
  EXPECT_EQ(e.eqps(4), 0);
}

TEST(S1, ObjectivityOfAPlasticPath) {  // (c)
  OneElement<J2<LinearFlow>> still(copper_j2(), random_hex(2, 0.1)), turned = still;
  double worst = 0;
  for (int n = 1; n <= 400; ++n) {
    const double t = n / 400.0;
    const Mat3 F{{{1 + 0.3 * t, 0.5 * t, 0}, {0, 1 - 0.2 * t, 0.3 * std::sin(5 * t)}, {0, 0.1 * t, 1}}};
    const Mat3 R = rotation({1, -1, 2}, 11 * t);
    const auto x = mapped(still.X, [&](const Vec3& X) { return F * X; });
    const auto y = mapped(x, [&](const Vec3& v) { return R * v; });
    still.force(x), turned.force(y);
    for (int i = 0; i < 8; i += 3) {
      EXPECT_NEAR(still.eqps(i), turned.eqps(i), 1e-10);
      const Sym3 a = still.cauchy(x, i), b = turned.cauchy(y, i);
      const double ratio = contract(deviator(a), deviator(a)) / contract(deviator(b), deviator(b));
      EXPECT_NEAR(ratio, 1, 1e-10);
      worst = std::fmax(worst, std::fmax(std::fabs(ratio - 1), std::fabs(still.eqps(i) - turned.eqps(i))));
    }
  }
  record("invariant_error", worst);
  EXPECT_GT(still.eqps(0), 0.3);
}

TEST(S5, HydrostaticCompression) {
  Model m = make_model(box({0, 0, 0}, {1, 1, 1}, {4, 4, 4}, 0.2), copper_j2());
  const double s = std::cbrt(0.9), p = 0.5 * copper.volumetric.kappa * (0.9 - 1 / 0.9);
  for (int n = 0; n < m.mesh.node_count(); ++n) m.state.x[NodeId(n)] = s * m.mesh.X[NodeId(n)];
  first_forces(m);
  double worst = 0;
  for (int e = 0; e < m.mesh.elem_count(); ++e) {
    const ElementResult r = evaluate(m.physics.elements, m.state, m.physics.elements.blocks.slot[ElemId(e)]);
    EXPECT_LT(largest(full(r.sigma - Sym3{p, p, p, 0, 0, 0})), 1e-12 * std::fabs(p));
    EXPECT_EQ(r.eqps_max, 0);
    worst = std::fmax(worst, largest(full(r.sigma - Sym3{p, p, p, 0, 0, 0})) / std::fabs(p));
  }
  record("pressure_error", worst);
}

TEST(Collapse, GuardIsTheEnergysFiniteDifferenceAndPushesBack) {
  OneElement<NeoHooke> e(copper_elastic(), random_hex(1, 0));
  for (const double push :
       {0.5, 0.8, 1.1}) {  // corner 6 towards (and beyond) the opposite one: points collapse, then invert
    Corners<double> x = e.X;
    x.a[6] -= push * Vec3{1, 1, 1};
    const auto r = e.force(x);
    ASSERT_GT(r.volume, 0);
    const Columns<double> g = columns_of(modes_of(x));
    double ratio = 1e300;
    for (int i = 0; i < 8; ++i)
      ratio = std::fmin(ratio, triple(g.at(0, i), g.at(1, i), g.at(2, i)) / e.J0(i) / (r.volume / e.V0));
    EXPECT_EQ(r.collapsed > 0, ratio < collapse_ratio) << push;
    const auto energy = [&](const Corners<double>& at) {
      Columns<double> q{}, gg = columns_of(modes_of(at));
      double sigma_m = 0, v = volume_of(modes_of(at));
      return collapse_guard(gg, e.history.data(), NeoHooke::components, v / e.V0, v, e.material.volumetric.kappa, q,
                            sigma_m);
    };
    Columns<double> q{};
    double sigma_m = 0;
    collapse_guard(g, e.history.data(), NeoHooke::components, r.volume / e.V0, r.volume, e.material.volumetric.kappa, q,
                   sigma_m);
    add_mean_stress(g, sigma_m, q);
    const Corners<double> f = forces_from_columns(q);
    for (int a = 0; a < 8; ++a)
      for (int d = 0; d < 3; ++d) {
        Corners<double> up = x, down = x;
        up.a[a][d] += 1e-6, down.a[a][d] -= 1e-6;
        EXPECT_NEAR(-(energy(up) - energy(down)) / 2e-6, f.a[a][d], 1e-6 * (1e9 + largest_force(f)));
      }
    if (ratio < collapse_ratio) {
      EXPECT_GT(dot(f.a[6], Vec3{1, 1, 1}), 0);
    }
  }
}

}  // namespace
}  // namespace bw::csd
