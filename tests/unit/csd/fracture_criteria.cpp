// SPDX-License-Identifier: Apache-2.0
// Failure criteria and the statistics of strength.
#include <algorithm>

#include "csd/fracture/failure.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

JohnsonCookDamage steel_4340_damage() {
  JohnsonCookDamage law;
  law.constants = {.D1 = 0.05, .D2 = 3.44, .D3 = -2.12, .D4 = 0.002, .D5 = 0.61};
  law.T_melt = 1793;
  return law;
}
const JohnsonCookDamage steel_4340 = steel_4340_damage();
const FailureData steel_data{0, 1793, steel_4340.constants};

TEST(FailureCriteria, JohnsonCookStrains) {  // VALIDATION S11
  const auto at = [](double star) { return steel_4340.strain_at_failure(star, 1, 293); };
  EXPECT_NEAR(at(-1.0 / 3), 7.02, 5e-3);
  EXPECT_NEAR(at(0), 3.49, 5e-3);
  EXPECT_NEAR(at(1.0 / 3), 1.747, 1e-3);
  EXPECT_NEAR(at(1), 0.463, 5e-4);
  EXPECT_EQ(at(3), at(1.5));
  EXPECT_NEAR(steel_4340.strain_at_failure(0, std::exp(10.0), 293), 3.49 * 1.02, 1e-9);
  EXPECT_DOUBLE_EQ(steel_4340.strain_at_failure(0, 1e-6, 293), 3.49);
  EXPECT_NEAR(steel_4340.strain_at_failure(0, 1, 1043), 3.49 * 1.305, 1e-9);  // T* = 0.5
}

/// A path of constant stress state and rate: damage after a plastic strain.
double damage_after(JohnsonCookDamage law, double eqps, double triaxiality, double rate, int steps) {
  double memory[3] = {0, 0, 0}, D = 0;
  for (int i = 1; i <= steps; ++i) {
    Sample s{.eqps = eqps * i / steps, .dt = eqps / (steps * rate)};
    if (law.wants_stress(s, memory)) {
      const double mean = triaxiality * 1e9;  // Mises 1 GPa: uniaxial part s_xx = 2/3, -1/3, -1/3
      s.has_stress = true, s.temperature = 293;
      s.sigma = {mean + 2e9 / 3, mean - 1e9 / 3, mean - 1e9 / 3, 0, 0, 0};
    }
    D = law.fail(s, memory);
  }
  return D;
}

TEST(FailureCriteria, JohnsonCookDamageAddsUp) {
  JohnsonCookDamage law = steel_4340;
  const double eps_f = steel_4340.strain_at_failure(0.5, 1e4, 293);
  for (const double strain_step : {0.0, 2e-3}) {
    law.strain_step = strain_step;
    EXPECT_NEAR(damage_after(law, 0.5 * eps_f, 0.5, 1e4, 2000), 0.5, strain_step / eps_f + 1e-12);
  }
  EXPECT_EQ(damage_after(law, 0.5, -0.5, 1e4, 1000), 0);  // compressed
  law.in_compression = true;
  EXPECT_GT(damage_after(law, 0.5, -0.5, 1e4, 1000), 0);
}

TEST(FailureCriteria, LargestPrincipalStress) {
  for (const Vec3& p : {Vec3{3, 1, -2}, Vec3{2, 2, -5}, Vec3{4, -1, -1}, Vec3{7, 7, 7}, Vec3{-1, -2, -3}}) {
    const Mat3 R = rotation({1, 2, -0.5}, 0.7);
    const Mat3 a = R * Mat3{{{p.x, 0, 0}, {0, p.y, 0}, {0, 0, p.z}}} * transpose(R);
    EXPECT_NEAR(largest_principal({a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(0, 2), a(1, 2)}), p.x, 1e-7);
  }
}

TEST(FailureCriteria, PrincipalStressMustLast) {
  PrincipalStress law;
  law.sigma_max = 1e9, law.duration = 10e-6;
  double above = 0;
  const auto step = [&](double stress) {
    return law.fail({.dt = 4e-6, .has_stress = true, .sigma = {stress, 0, 0, 0, 0, 0}}, &above);
  };
  EXPECT_NEAR(step(1.1e9), 0.4, 1e-12);
  EXPECT_NEAR(step(1.1e9), 0.8, 1e-12);
  EXPECT_EQ(step(0.9e9), 0);  // a break
  for (int i = 0; i < 3; ++i) step(1.0e9);
  EXPECT_GE(above, law.duration);
}

TEST(FailureCriteria, WeibullStrengths) {
  Scatter scatter;
  scatter.modulus = 8;
  const int n = 20000;
  std::vector<double> strength;
  double mean = 0;
  for (int e = 0; e < n; ++e) strength.push_back(scatter.strength(e, 1e-9)), mean += strength.back() / n;
  EXPECT_NEAR(mean, 1, 5e-3);
  std::sort(strength.begin(), strength.end());
  double distance = 0;  // Kolmogorov and Smirnov's
  for (int i = 0; i < n; ++i) {
    const double P = 1 - std::exp(-std::pow(strength[size_t(i)] * std::tgamma(1 + 1.0 / 8), 8));
    distance = std::fmax(distance, std::fabs(P - (i + 0.5) / n));
  }
  EXPECT_LT(distance, 1.63 / std::sqrt(n));  // 1 % level
  scatter.reference_volume = 1e-9;
  EXPECT_NEAR(scatter.strength(7, 256e-9) / scatter.strength(7, 1e-9), 0.5, 1e-12);
  scatter.seed = 2;
  EXPECT_NE(scatter.strength(7, 1e-9), Scatter{.modulus = 8}.strength(7, 1e-9));
}

/// A bar that flies into itself: waves run through it, most of it rests at first.
Model struck(const Materials& material) {
  return make_model(box({0, 0, 0}, {0.08, 0.01, 0.01}, {48, 4, 4}, 0.1), material, [](const Vec3& X) {
    return Vec3{X.x > 0.06 ? 400.0 : 0.0, 0, 0};
  });
}

TEST(FailureCriteria, SkippingWhatIsSafeChangesNothing) {
  std::vector<Criteria> kinds{EqpsLimit{0.3}, SpallLimit{1e9}};
  kinds.push_back(PrincipalStress{.sigma_max = 1.2e9, .duration = 1e-6});
  kinds.push_back(JohnsonCookDamage{});
  for (const Criteria& kind : kinds) {
    Model m = struck(copper_j2());
    m.physics.resting.start(m.physics.elements.blocks.block_count());
    FractureInput input;
    input.criterion.model = kind;
    Failure quick(input, m.mesh, {steel_data});
    input.skip_safe = false;
    Failure all(input, m.mesh, {steel_data});
    double worst = 0;
    for (int n = 0; n < 60; ++n) {
      step(m, 0.9 * stable(m));
      for (Failure* f : {&quick, &all}) f->update(m.physics.elements, m.state, m.physics.resting, nullptr);
      ASSERT_EQ(quick.values(), all.values()) << kind.index() << " step " << n;
      for (const double fail : all.values()) worst = std::fmax(worst, fail);
    }
    EXPECT_GT(worst, 0.01) << kind.index();
    EXPECT_LE(quick.examined(), all.examined());
    if (std::holds_alternative<PrincipalStress>(kind)) {
      EXPECT_LT(quick.examined(), all.examined() / 4);
    }
  }
}

TEST(FailureCriteria, ValuesAreTheStressesOfTheElements) {
  Model m = struck(copper_j2());
  FractureInput input;
  input.criterion.model = SpallLimit{1e9};
  Failure spall(input, m.mesh, {});
  for (int n = 0; n < 60; ++n) step(m, 0.9 * stable(m));
  spall.update(m.physics.elements, m.state, m.physics.resting, nullptr);
  for (int e = 0; e < m.mesh.elem_count(); ++e) {
    const SlotId slot = m.physics.elements.blocks.slot[ElemId(e)];
    const Sym3 sigma = evaluate(m.physics.elements, m.state, slot).sigma;
    EXPECT_NEAR(spall.values()[size_t(e)], trace(sigma) / 3e9, 1e-9);
    EXPECT_GE(mises_most(m.physics.elements, m.state, slot), von_mises(sigma));
  }
}

TEST(FailureCriteria, StrengthDividesTheValue) {
  Model m = struck(copper_j2());
  FractureInput input;
  input.criterion.model = EqpsLimit{0.3};
  Failure plain(input, m.mesh, {});
  input.scatter = Scatter{.modulus = 5};
  Failure random(input, m.mesh, {});
  for (int n = 0; n < 40; ++n) step(m, 0.9 * stable(m));
  for (Failure* f : {&plain, &random}) f->update(m.physics.elements, m.state, m.physics.resting, nullptr);
  for (int e = 0; e < m.mesh.elem_count(); ++e)
    EXPECT_NEAR(random.values()[size_t(e)] * input.scatter->strength(m.mesh.elem_gid[ElemId(e)], 0),
                plain.values()[size_t(e)], 1e-12);
}

TEST(FailureCriteria, AskTheMaterial) {
  EXPECT_FALSE(SpallLimit{}.is_known(steel_data));
  EXPECT_TRUE(SpallLimit{}.is_known({.spall_stress = 2e9}));
  EXPECT_TRUE(JohnsonCookDamage{}.is_known(steel_data));
  EXPECT_FALSE(JohnsonCookDamage{}.is_known({}));
  SpallLimit spall;
  spall.take({.spall_stress = 2e9});
  EXPECT_EQ(spall.fail({.sigma_m = 1e9}, nullptr), 0.5);
}

}  // namespace
}  // namespace bw::csd
