// SPDX-License-Identifier: Apache-2.0
// Properties that every material of the list must have, on the whole library and on samples of what it doesn't hold.
#include <gtest/gtest.h>

#include "csd/material/material_case.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

struct Sample {
  std::string name;
  Materials material;
};
const Elastic steel{7830, 206e9, 0.29};

/// The library, and the flow stresses and rate laws that it doesn't use.
std::vector<Sample> samples() {
  std::vector<Sample> list;
  for (const LibraryEntry& entry : material_library()) {
    MaterialCase cs;
    cs.choice = entry.material;
    list.push_back({entry.name, make_material(cs)});
  }
  SaturationFlow saturation;
  saturation.sigma_Y = 450e6, saturation.K_iso = 129e6, saturation.sigma_inf = 715e6, saturation.delta = 16.93;
  const TableFlow table{{{0, 0.02, 0.1, 0.5, 1}, {300e6, 400e6, 520e6, 700e6, 650e6}}};
  IncreaseFactor factor;
  factor.set({1e-3, 1, 100, 1e4}, {1, 1.1, 1.3, 1.9});
  const Heat heat{477, 0.9, 293};
  list.push_back({"neo-Hooke", NeoHooke(7830, 206e9, 0.29)});
  list.push_back({"saturation", J2(steel, saturation, heat)});
  list.push_back({"table", J2(steel, table, heat)});
  list.push_back({"Cowper-Symonds", RateJ2(steel, RateFlow{LinearFlow{400e6, 1e9}, CowperSymonds{40, 5}}, heat)});
  list.push_back({"increase factor", RateJ2(steel, RateFlow{table, factor}, heat)});
  return list;
}
template <class Test>
void for_samples(const Test& test) {
  for (const Sample& sample : samples()) {
    SCOPED_TRACE(sample.name);
    std::visit([&](const auto& m) { test(m, sample.name); }, sample.material);
  }
}
template <class M>
constexpr bool has_rate = requires(const M& m) {
  m.first_yield;
};

TEST(MaterialProperties, EveryAlternativeHasASample) {
  std::vector<bool> seen(std::variant_size_v<Materials>);
  for (const Sample& sample : samples()) seen[sample.material.index()] = true;
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_TRUE(seen[i]) << "alternative " << i << " of Materials";
}

/// Axes turn, one direction grows, the volume swings by some percent.
Mat3 path(double t) {
  Mat3 F = Mat3::identity();
  F(0, 0) = 1 + 0.3 * t, F(1, 1) = 1 - 0.2 * t, F(0, 1) = 0.8 * std::sin(3 * t), F(1, 2) = 0.5 * t * t;
  F(2, 0) = -0.4 * t, F(2, 2) = 1 / (F(0, 0) * F(1, 1)) + 0.02 * std::sin(40 * t);
  return F;
}
template <class M>
OneElement<M> element(const M& material) {
  return {material, random_hex(5, 0.1, 1e-3)};
}
template <class M>
Corners<double> along_path(const OneElement<M>& e, double t) {
  const Mat3 F = path(t);
  return mapped(e.X, [&](const Vec3& X) { return F * X; });
}
constexpr double step_time = 1e-7;  // s; rates of the path: some 1e4 /s

template <class M>
double kirchhoff_mises(const OneElement<M>& e, const Corners<double>& x, int i) {
  const Point<double> p = e.point(x, i);
  return e.material.mu * p.trial.iso * std::sqrt(1.5 * p.trial.dev2);
}
/// Flow stress at a point that went from eqps and temperature to where it is.
template <class M>
double flow_stress(const OneElement<M>& e, int i, [[maybe_unused]] double eqps, [[maybe_unused]] double temperature) {
  if constexpr (has_rate<M>)
    return e.material.flow.at(temperature).stress(e.eqps(i), (e.eqps(i) - eqps) / step_time).value;
  else
    return e.material.flow.stress(e.eqps(i));
}

TEST(MaterialProperties, ForceIsTheEnergysGradientAfterFlow) {
  for_samples([](const auto& material, const std::string&) {
    auto e = element(material);
    for (int n = 1; n <= 20; ++n) e.force(along_path(e, 0.01 * n), step_time);
    const auto x = along_path(e, 0.2);
    const auto f = e.force(x).f;
    const double h = 1e-9;
    double largest_force = 0, worst = 0;
    for (int a = 0; a < 8; ++a)
      for (int d = 0; d < 3; ++d) {
        Corners<double> up = x, down = x;
        up.a[a][d] += h, down.a[a][d] -= h;
        worst = std::fmax(worst, std::fabs(-(e.energy(up) - e.energy(down)) / (2 * h) - f.a[a][d]));
        largest_force = std::fmax(largest_force, std::fabs(f.a[a][d]));
      }
    EXPECT_LT(worst, 1e-6 * largest_force);
  });
}

TEST(MaterialProperties, ReturnEndsOnTheYieldSurface) {
  for_samples([]<class M>(const M& material, const std::string& name) {
    if constexpr (M::plastic) {
      auto e = element(material);
      double worst = 0, before = 0;
      int flowing = 0;
      for (int n = 1; n <= 600; ++n) {
        const double t = 0.5 - 0.5 * std::cos(0.02 * n), eqps = e.eqps(3), temperature = material.temperature(e.at(3));
        const auto x = along_path(e, t);
        e.force(x, step_time);
        const double mises = kirchhoff_mises(e, x, 3), sigma_y = flow_stress(e, 3, eqps, temperature);
        if (e.eqps(3) > eqps + 1e-9)  // the rate is known here as a difference of eqps
          worst = std::fmax(worst, std::fabs(mises / sigma_y - 1)), ++flowing;
        else
          EXPECT_LE(mises, sigma_y * (1 + 1e-3));
        EXPECT_GE(e.eqps(3), eqps);
        EXPECT_GE(material.plastic_work(e.at(3)), before);  // dissipation
        before = material.plastic_work(e.at(3));
      }
      EXPECT_GT(flowing, 300);
      EXPECT_LT(worst, 1e-7) << name;
    }
  });
}

TEST(MaterialProperties, FlowKeepsTheVolume) {
  for_samples([]<class M>(const M& material, const std::string&) {
    auto e = element(material);
    const double start = det(load_sym<double>(e.at(6)));
    double worst = 0;
    for (int n = 1; n <= 1500; ++n) {
      e.force(along_path(e, n / 1000.0), step_time);
      worst = std::fmax(worst, std::fabs(det(load_sym<double>(e.at(6))) / start - 1));  // det C_p^-1
    }
    if constexpr (M::plastic) {
      EXPECT_GT(e.eqps(6), 0.5);
    }
    EXPECT_LT(worst, 1e-12);
  });
}

TEST(MaterialProperties, RotationChangesNothing) {
  for_samples([]<class M>(const M& material, const std::string&) {
    auto still = element(material), turned = still;
    for (int n = 1; n <= 200; ++n) {
      const Mat3 R = rotation({1, -1, 2}, 0.05 * n);
      const auto x = along_path(still, n / 200.0);
      const auto y = mapped(x, [&](const Vec3& v) { return R * v; });
      const auto f = still.force(x, step_time).f, g = turned.force(y, step_time).f;
      const double scale = 1e-3 * 1e-3 * material.mu;
      for (int a = 0; a < 8; ++a) EXPECT_LT(norm(R * f.a[a] - g.a[a]), 1e-10 * scale);
      if constexpr (M::plastic) {
        EXPECT_NEAR(still.eqps(2), turned.eqps(2), 1e-10);
      }
    }
  });
}

TEST(MaterialProperties, PackEqualsScalar) {  // to round-off: the compiler fuses multiply-adds as it likes
  for_samples([]<class M>(const M& material, const std::string&) {
    constexpr int rows = 8 * M::components;
    Aligned<double> packed(rows * lanes, 0.0);
    std::vector<OneElement<M>> single;
    for (int l = 0; l < Pack::size; ++l) {
      single.push_back(element(material));
      for (size_t i = 0; i < rows; ++i) packed[i * lanes + size_t(l)] = single.back().history[i * lanes];
    }
    for (int n = 1; n <= 30; ++n) {
      Corners<Pack> x;
      for (int l = 0; l < Pack::size; ++l) {  // the first lane stays elastic
        const auto one = along_path(single[size_t(l)], (l == 0 ? 1e-6 : 0.003 * l) * n);
        for (int a = 0; a < 8; ++a)
          x.a[a].x.set(l, one.a[a].x), x.a[a].y.set(l, one.a[a].y), x.a[a].z.set(l, one.a[a].z);
        single[size_t(l)].force(one, step_time);
      }
      internal_force<Pack>(
          material, x, Pack(single[0].V0), packed.data(), [&](Pack J) { return material.volumetric.mean_stress(J); },
          1 / step_time);
    }
    for (int l = 0; l < Pack::size; ++l)
      for (size_t i = 0; i < rows; ++i) {
        const double expected = single[size_t(l)].history[i * lanes];
        EXPECT_NEAR(packed[i * lanes + size_t(l)], expected, 1e-9 * std::fabs(expected) + 1e-12);
      }
  });
}

TEST(MaterialProperties, WorkOfTheForcesIsStoredOrSpent) {
  for_samples([]<class M>(const M& material, const std::string& name) {
    double stress_over_mu = 0;
    const auto defect = [&](int steps) {
      auto e = element(material);
      auto x = e.X;
      auto f = e.force(x).f;
      double work = 0;
      for (int n = 1; n <= steps; ++n) {
        const auto to = along_path(e, 0.4 * n / steps);
        const auto after = e.force(to, 400 * step_time / steps).f;
        for (int a = 0; a < 8; ++a) work -= 0.5 * dot(f.a[a] + after.a[a], to.a[a] - x.a[a]);
        x = to, f = after;
        stress_over_mu = std::fmax(stress_over_mu, kirchhoff_mises(e, x, 0) / material.mu);
      }
      double held = e.energy(x);
      if constexpr (M::plastic)
        for (int i = 0; i < 8; ++i) held += e.J0(i) * material.plastic_work(e.at(i));
      return std::fabs(held / work - 1);
    };
    // the work of flow is counted as sigma_y d(eqps), right to the first order of s/mu
    const double fine = defect(1600);
    EXPECT_LT(fine, M::plastic ? 0.1 * stress_over_mu : 1e-6) << name;
  });
}

TEST(MaterialProperties, WorkHeats) {
  for_samples([]<class M>(const M& material, const std::string&) {
    if constexpr (M::plastic) {
      auto e = element(material);
      EXPECT_EQ(material.temperature(e.at(0)), material.heat.initial);
      for (int n = 1; n <= 100; ++n) e.force(along_path(e, 0.005 * n), step_time);
      const Heat& heat = material.heat;
      const double rise = heat.specific_heat > 0 ? heat.taylor_quinney * material.plastic_work(e.at(0)) /
                                                       (material.density * heat.specific_heat)
                                                 : 0;
      EXPECT_NEAR(material.temperature(e.at(0)) - heat.initial, rise, 1e-12 * heat.initial);
      EXPECT_EQ(rise > 1, heat.specific_heat > 0);
    }
  });
}

TEST(MaterialProperties, ConstantsArePositive) {
  for_samples([](const auto& m, const std::string&) {
    EXPECT_GT(m.density, 0);
    EXPECT_GT(m.mu, 0);
    EXPECT_GT(m.volumetric.kappa, 0);
  });
  for (const LibraryEntry& entry : material_library()) {
    EXPECT_FALSE(entry.source.empty()) << entry.name;
    const auto* j2 = std::get_if<J2Case>(&entry.material);
    if (!j2 || entry.hugoniot.c0 == 0) continue;  // rho c0^2 and the elastic bulk modulus speak of one metal
    EXPECT_NEAR(j2->density * entry.hugoniot.c0 * entry.hugoniot.c0 / j2->volumetric.kappa, 1, 0.18) << entry.name;
  }
}

/// A library material as a case reads it, with more keys.
MaterialCase read_material(const std::string& name, const std::string& more = "") {
  MaterialCase cs;
  Keys keys = Keys::read_text(fmt::format("library = \"{}\"\n{}", name, more), "case.toml");
  cs.describe(keys);
  keys.finish();
  return cs;
}

TEST(Library, EveryMaterialIsReadAndHasSpeedsOfAMetal) {
  for (const LibraryEntry& entry : material_library()) {
    SCOPED_TRACE(entry.name);
    const MaterialCase cs = read_material(entry.name);
    std::visit(
        [&](const auto& m) {
          const double longitudinal = m.sound_speed(), shear = std::sqrt(m.mu / m.density);
          const bool is_paper = entry.name == "paper";  // 641.5 GPa
          EXPECT_GT(longitudinal, 4000);
          EXPECT_LT(longitudinal, is_paper ? 10600 : 6600);
          EXPECT_GT(shear, 2000);
          EXPECT_LT(shear, is_paper ? 5700 : 3300);
          EXPECT_NEAR(shear / longitudinal, std::sqrt((1 - 2 * m.nu) / (2 - 2 * m.nu)), 1e-12);
        },
        make_material(cs));
    if (entry.hugoniot.c0 == 0) continue;
    const auto j2 = std::get<J2Case>(read_material(entry.name, "volumetric = {kind = \"mie_gruneisen\"}").choice);
    EXPECT_DOUBLE_EQ(j2.volumetric.kappa, j2.density * entry.hugoniot.c0 * entry.hugoniot.c0);
    EXPECT_GT(entry.hugoniot.s, 1.2);
    EXPECT_LT(entry.hugoniot.s, 1.5);
    const double above_ambient = cs.failure.melting_temperature - 293;
    EXPECT_GT(above_ambient, 0);
    if (!cs.failure.damage) continue;
    const DamageConstants& D = *cs.failure.damage;
    const auto strain = [&](double s) { return D.D1 + D.D2 * std::exp(D.D3 * s); };  // at failure
    EXPECT_GT(strain(1.0), 0.05);
    EXPECT_GT(strain(0.0), strain(1.0));
    EXPECT_LT(strain(1.0 / 3), 3.0);
  }
}

TEST(Library, DamageOf4340HasTheSpotValues) {  // VALIDATION S11
  const MaterialCase cs = read_material("steel 4340");
  const DamageConstants& D = *cs.failure.damage;
  const auto strain = [&](double s) { return D.D1 + D.D2 * std::exp(D.D3 * s); };
  EXPECT_NEAR(strain(-1.0 / 3), 7.02, 0.005);
  EXPECT_NEAR(strain(0), 3.49, 0.005);
  EXPECT_NEAR(strain(1.0 / 3), 1.747, 0.0005);
  EXPECT_NEAR(strain(1), 0.463, 0.0005);
  EXPECT_EQ(cs.failure.melting_temperature, 1793);
}

TEST(Library, FailureDataAreKeysOfAnyMaterial) {
  const MaterialCase changed = read_material(
      "copper OFHC",
      "spall_stress = \"1.3 GPa\"\nmelting_temperature = 1400.0\ndamage = {D1 = 0.1, D2 = 1.0, D3 = -1.5, "
      "D4 = 0.0, D5 = 0.0}\n");
  EXPECT_EQ(changed.failure.spall_stress, 1.3e9);
  EXPECT_EQ(changed.failure.melting_temperature, 1400);
  EXPECT_EQ(changed.failure.damage->D3, -1.5);
  EXPECT_THROW(read_material("copper OFHC", "damage = {D1 = 0.1}"), InputError);
  EXPECT_THROW(read_material("copper OFHC", "damage = {D1 = 0.1, D2 = 1.0, D3 = 1.5, D4 = 0.0, D5 = 0.0}"), InputError);
  EXPECT_FALSE(read_material("steel 1006").failure.damage);
}

TEST(VolumetricLaws, StressAndStiffnessAreDerivatives) {
  for (const VolumetricLaws& law : {VolumetricLaws(PaperVolume()), VolumetricLaws(MieGruneisen{3940, 1.489}),
                                    VolumetricLaws(MieGruneisen{3574, 1.92}), VolumetricLaws(Murnaghan{4.5})}) {
    const Elastic m(8960, 124e9, 0.34, law);
    const Volumetric& U = m.volumetric;
    double below = -1e300;
    for (double J = 0.3; J < 3; J += 0.0103) {
      const double h = 1e-6;
      EXPECT_NEAR((U.energy(J + h) - U.energy(J - h)) / (2 * h), U.mean_stress(J), 1e-7 * U.kappa * (1 + 1 / J / J));
      const double stiffness = J * (U.mean_stress(J + h) - U.mean_stress(J - h)) / (2 * h);
      EXPECT_NEAR(stiffness / U.stiffness(J), 1, 1e-4) << law.index() << " " << J;
      EXPECT_GT(U.mean_stress(J), below);  // monotone
      below = U.mean_stress(J);
      const Pack packed = U.mean_stress(Pack(J));
      EXPECT_NEAR(packed[0], below, 1e-13 * U.kappa * (1 + std::fabs(below / U.kappa)));
    }
    EXPECT_EQ(U.mean_stress(1.0), 0);
    EXPECT_NEAR(U.energy(1.0), 0, 1e-15 * U.kappa);
    EXPECT_NEAR(U.stiffness(1.0), U.kappa, 1e-12 * U.kappa);
  }
}

TEST(VolumetricLaws, ShocksHaveTheGivenSpeed) {  // of a liquid: mass and momentum across the front give U_s and u_p
  const double c0 = 3940, s = 1.489, density = 8960;
  const Elastic m(density, 124e9, 0.34, MieGruneisen{c0, s});
  for (double u : {100.0, 500.0, 1500.0}) {
    const double speed = c0 + s * u, J = 1 - u / speed;
    EXPECT_NEAR(-m.volumetric.mean_stress(J), density * speed * u, 1e-12 * density * speed * u);
  }
}

TEST(JohnsonCookFlow, T18HotAndFast) {  // 1e7 /s up to the melting temperature and beyond
  const JohnsonCook law{.A = 90e6, .B = 292e6, .n = 0.31, .C = 0.025, .m = 1.09, .T_melt = 1356};
  for (double start : {293.0, 1300.0, 1355.9, 1356.0, 2000.0})
    for (double stretch : {0.02, 0.3}) {  // eqps of a step: 0.01 in 1e-9 s, and far more
      const RateJ2 material(Elastic(8960, 124e9, 0.34), law, Heat{383, 0.9, start});
      auto e = element(material);
      for (int n = 1; n <= 200; ++n) {
        Mat3 F = Mat3::identity();
        F(0, 1) = stretch * n;
        const auto x = mapped(e.X, [&](const Vec3& X) { return F * X; });
        const double eqps = e.eqps(0), temperature = material.temperature(e.at(0)), dt = 1e-9;
        e.force(x, dt);
        const double rate = (e.eqps(0) - eqps) / dt, mises = kirchhoff_mises(e, x, 0);
        const double sigma_y = law.at(temperature).stress(e.eqps(0), rate).value;
        ASSERT_TRUE(std::isfinite(mises) && std::isfinite(e.at(0)[8 * lanes]));
        EXPECT_GE(sigma_y, 0);
        EXPECT_GT(rate, 5e6);
        EXPECT_NEAR(mises, sigma_y, 1e-7 * material.mu);
        EXPECT_GE(material.temperature(e.at(0)), temperature);
      }
      EXPECT_NEAR(kirchhoff_mises(e,
                                  mapped(e.X,
                                         [&](const Vec3& X) {
                                           return X + Vec3{stretch * 200 * X.y, 0, 0};
                                         }),
                                  0),
                  0, start >= 1356 ? 1.0 : 1e9);
    }
}

TEST(JohnsonCookFlow, ColdAndSlowIsTheStressAtRest) {
  const JohnsonCook law{.A = 792e6, .B = 510e6, .n = 0.26, .C = 0.014, .m = 1.03, .T_melt = 1793};
  EXPECT_NEAR(law.at(250.0).stress(0.1, 0.5).value, 792e6 + 510e6 * std::pow(0.1, 0.26), 1);
  EXPECT_NEAR(law.at(293.0).at_rest(0.0), 792e6, 20);
  EXPECT_NEAR(law.at(1793.0).at_rest(0.3), 0, 1e-3);
}

}  // namespace
}  // namespace bw::csd
