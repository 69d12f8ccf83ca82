// SPDX-License-Identifier: Apache-2.0
// The bound on the largest eigenfrequency against dense eigenvalues of the element's tangent.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "csd/element/stable_step.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

/// omega^2 max of the element, from central differences of its forces.
template <class M>
double dense_omega2(OneElement<M>& e, const Corners<double>& x) {
  Eigen::Matrix<double, 24, 24> K;
  const double h = 1e-5 * std::cbrt(e.V0);
  for (int j = 0; j < 24; ++j) {
    Corners<double> up = x, down = x;
    up.a[j / 3][j % 3] += h, down.a[j / 3][j % 3] -= h;
    const auto fu = e.force(up).f, fd = e.force(down).f;
    for (int i = 0; i < 24; ++i) K(i, j) = -(fu.a[i / 3][i % 3] - fd.a[i / 3][i % 3]) / (2 * h);
  }
  const auto share = row_sums(e.X);
  for (int i = 0; i < 24; ++i)
    for (int j = 0; j < 24; ++j) K(i, j) /= e.material.density * std::sqrt(share[size_t(i / 3)] * share[size_t(j / 3)]);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 24, 24>>(0.5 * (K + K.transpose())).eigenvalues()(23);
}

template <class M>
double bound(OneElement<M>& e, const Corners<double>& x) {
  const auto share = row_sums(e.X);
  double mass[8];
  for (int a = 0; a < 8; ++a) mass[a] = e.material.density * share[size_t(a)];
  const double sigma_m = e.material.volumetric.mean_stress(volume_of(modes_of(x)) / e.V0);
  return omega2_bound<double>(e.material, x, e.V0, mass, sigma_m, e.history.data());
}

Mat3 random_stretch(uint64_t seed, double size) {
  Mat3 F = Mat3::identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) F(i, j) += size * noise(seed, uint64_t(10 * i + j));
  return F;
}

/// Least and largest of omega_bound / omega over many elements.
struct Sharpness {
  double least = 1e300, largest = 0, mean = 0;
};
template <class M>
Sharpness sharpness(const M& material, double distortion, double flatness, double strain, int count) {
  Sharpness s;
  for (int n = 0; n < count; ++n) {
    const uint64_t seed = uint64_t(n);
    Corners<double> X = mapped(random_hex(seed, distortion), [&](const Vec3& p) {
      return Vec3{p.x, 0.6 * p.y, flatness * p.z};
    });
    OneElement<M> e(material, X);
    const Mat3 F = random_stretch(seed + 1000, strain);
    const auto x = mapped(X, [&](const Vec3& p) { return F * p; });
    const double ratio = std::sqrt(bound(e, x) / dense_omega2(e, x));
    s.least = std::fmin(s.least, ratio), s.largest = std::fmax(s.largest, ratio), s.mean += ratio / count;
  }
  return s;
}

TEST(StableStep, ExactForABrickAtRest) {
  for (double nu : {0.0, 0.3, 0.45}) {
    const NeoHooke m(7800, 206e9, nu);
    for (double flat : {1.0, 0.3, 0.02}) {
      const Sharpness s = sharpness(m, 0, flat, 0, 1);
      EXPECT_GE(s.least, 1 - 1e-7);
      EXPECT_LE(s.largest, 1.02) << nu << " " << flat;
    }
  }
}

TEST(StableStep, NeverUnsafe) {
  const NeoHooke steel(7800, 206e9, 0.3), rubber(1000, 1e6, 0.49), foam(100, 1e6, -0.3);
  double worst = 1e300;
  for (double distortion : {0.0, 0.05, 0.15, 0.25})
    for (double flat : {1.0, 0.2})
      for (double strain : {0.0, 0.05, 0.3}) {
        for (const NeoHooke& m : {steel, rubber, foam}) {
          const Sharpness s = sharpness(m, distortion, flat, strain, 40);
          worst = std::fmin(worst, s.least);
          EXPECT_GE(s.least, 1 - 1e-6) << "distortion " << distortion << " flat " << flat << " strain " << strain
                                       << " nu " << m.nu;
          if (m.nu == 0.3)
            printf("distortion %.2f flat %.1f strain %.2f: bound/true %.3f .. %.3f, mean %.3f\n", distortion, flat,
                   strain, s.least, s.largest, s.mean);
        }
      }
  RecordProperty("least_bound_over_true", std::to_string(worst));
}

TEST(StableStep, VolumetricLawsCount) {  // their stiffness grows under pressure, and falls in tension
  for (const VolumetricLaws& law :
       {VolumetricLaws(PaperVolume()), VolumetricLaws(MieGruneisen{3940, 1.489}), VolumetricLaws(Murnaghan{4.5})}) {
    const NeoHooke m(8960, 124e9, 0.34, law);
    for (double J : {0.7, 0.85, 1.0, 1.06})
      for (uint64_t seed = 0; seed < 8; ++seed) {
        OneElement<NeoHooke> e(m, random_hex(seed, 0.1));
        const auto x = mapped(e.X, [&](const Vec3& p) { return std::cbrt(J) * p; });
        EXPECT_GE(bound(e, x), dense_omega2(e, x) * (1 - 1e-6)) << law.index() << " " << J;
      }
  }
}

TEST(StableStep, PressureCounts) {  // 10 GPa and more, either sign
  const J2<LinearFlow> m(Elastic(7800, 206e9, 0.3), LinearFlow{1e15, 0});
  for (double J : {0.85, 0.94, 1.06})
    for (uint64_t seed = 0; seed < 20; ++seed) {
      OneElement<J2<LinearFlow>> e(m, random_hex(seed, 0.1));
      const auto x = mapped(e.X, [&](const Vec3& p) { return std::cbrt(J) * p; });
      EXPECT_GE(bound(e, x), dense_omega2(e, x) * (1 - 1e-6));
    }
}

TEST(StableStep, CollapsedPointsCount) {  // a corner pushed in until its point has lost most of its volume
  for (double push : {0.5, 0.62, 0.7, 0.75, 0.8, 0.9}) {
    OneElement<NeoHooke> e(copper_elastic(), random_hex(1, 0));
    Corners<double> x = e.X;
    x.a[6] -= push * Vec3{1, 1, 1};
    const double ratio = std::sqrt(bound(e, x) / dense_omega2(e, x));
    printf("corner pushed by %.2f: bound/true %.3f\n", push, ratio);
    EXPECT_GE(ratio, 1 - 1e-6) << push;
  }
}

}  // namespace
}  // namespace bw::csd
