// SPDX-License-Identifier: Apache-2.0
// Runs along a radius: rest, conservation, order against exact sound in a sphere and a cylinder, detonation, equal
// bits.
#include <fmt/format.h>

#include <cmath>

#include "cfd/output.h"
#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

std::string along_radius(const std::string& geometry, int cells, double radius, const std::string& more = "") {
  return fmt::format("[fluid]\ngeometry = \"{}\"\nradius = {}\ncells = [{}, 1, 1]\n", geometry, radius, cells) + more;
}
const std::string geometries[2] = {"cylindrical", "spherical"};
double whole(const std::string& geometry, double r) {
  return geometry == "spherical" ? 4 * M_PI / 3 * r * r * r : M_PI * r * r;
}

TEST(Radial, VolumesAreThoseOfTheBody) {
  for (const std::string& g : geometries) {
    const Flow f(along_radius(g, 60, 0.7, "inner_radius = 0.2\n") + air_and_tnt +
                 tnt_ball("[0, 0, 0]", 0.4321, "unburnt = true\n"));
    EXPECT_NEAR(f.sums().volume / (whole(g, 0.7) - whole(g, 0.2)), 1, 1e-13);
    EXPECT_NEAR(f.sums().U[0] / (1630 * (whole(g, 0.4321) - whole(g, 0.2))), 1, 1e-13) << g;  // a painted ball is exact
  }
}

TEST(Radial, GasAtRestStaysAtRest) {
  for (const std::string& g : geometries)
    for (const char* inner : {"", "inner_radius = 0.05\n", "inner_radius = 0.137\n"}) {
      Flow f(along_radius(g, 40, 1, inner) + still_air + R"([[fluid.region]]
shape = {kind = "sphere", centre = [0, 0, 0], radius = 0.333}
material = "air"
density = 3.3
pressure = 101325
)",
             false);
      const std::vector<double> before = f.bits();
      f.steps(200);
      const std::vector<double> after = f.bits();
      for (size_t i = 0; i < before.size(); ++i)
        ASSERT_NEAR(after[i], before[i], 1e-12 * std::abs(before[i]) + 1e-10) << g << i;
    }
}

TEST(Radial, ContactOfTwoMaterialsStaysAtRest) {
  for (const std::string& g : geometries) {
    Flow f(along_radius(g, 64, 1) + air_and_tnt + tnt_ball("[0, 0, 0]", 0.41, "density = 50\n"));
    f.steps(300);
    const Departure worst = departure(f, 0, 340);
    EXPECT_LT(worst.p, 1e-11) << g;
    EXPECT_LT(worst.v, 1e-11) << g;
  }
}

TEST(Radial, ClosedVesselKeepsMassAndEnergy) {
  for (const std::string& g : geometries) {
    Flow f(along_radius(g, 100, 0.5) + air_and_tnt + R"([[fluid.region]]
shape = {kind = "sphere", centre = [0, 0, 0], radius = 0.151}
material = "TNT"
density = 900
pressure = 3e9
)");
    const FluidSums before = f.sums();
    f.steps(600);  // reflected several times
    const FluidSums after = f.sums();
    const Booked b = f.books.booked(f.m);
    for (int q : {int(Cons::arho1), int(Cons::arho2), int(Cons::rhoE)})
      EXPECT_NEAR(after.U[q] + b.cleaned[q] - (q == Cons::rhoE ? b.floor_energy : 0), before.U[q],
                  1e-13 * std::abs(before.U[q]))
          << g;
  }
}

/// Error (L1 of pressure over its amplitude, per volume) after one period of the first standing wave of sound in a
/// closed vessel: p' = cos(kct) j(kr) with j = sin(x)/x (sphere) or the Bessel function J0 (cylinder).
double error_of_sound(const std::string& g, int n) {
  const bool sphere = g == "spherical";
  const double p0 = 101325, rho0 = 1.225, c = std::sqrt(1.4 * p0 / rho0), size = 1e-6 * p0;
  const double k = sphere ? 4.4934094579090642 : 3.8317059702075123;  // wall at r = 1: no velocity there
  const auto shape = [&](double r) { return sphere ? std::sin(k * r) / (k * r) : std::cyl_bessel_j(0.0, k * r); };
  Flow f(along_radius(g, n, 1) + still_air);
  const BlockShape& s = f.m.forest.shape();
  const auto mean = [&](double a) {  // Gauss, with the shell's own weight
    static constexpr double at[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
    static constexpr double weight[4] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
    double sum = 0, all = 0;
    for (int q = 0; q < 4; ++q) {
      const double r = a + 0.5 * s.h.x * (1 + at[q]), w = weight[q] * (sphere ? r * r : r);
      sum += w * shape(r), all += w;
    }
    return sum / all;
  };
  for (int b : f.all()) {
    for (int i = 0; i < s.n[0]; ++i) {
      const double p = size * mean(f.m.forest.lower(b).x + i * s.h.x);
      f.m.state.block(b, Cons::arho1)[i] = rho0 + p / (c * c);
      f.m.state.block(b, Cons::rhoE)[i] = (p0 + p) / 0.4;
    }
  }
  inspect(f.m, f.all());
  const double period = 2 * M_PI / (k * c);
  const int steps = int(std::ceil(period * f.sweep.max_rate(f.m.state) / 0.8));
  f.steps(steps, period / steps);
  double error = 0, volume = 0;
  for (int b : f.all())
    for (int i = 0; i < s.n[0]; ++i) {
      const double a = f.m.forest.lower(b).x, v = s.cell_volume(a, i);
      error += v * std::abs((f.m.state.block(b, Cons::rhoE)[i] * 0.4 - p0) / size - mean(a + i * s.h.x));
      volume += v;
    }
  return error / volume;
}

TEST(Radial, SoundIsSecondOrder) {
  for (const std::string& g : geometries) {
    const double coarse = error_of_sound(g, 32), middle = error_of_sound(g, 64), fine = error_of_sound(g, 128);
    RecordProperty("order_" + g, fmt::format("{:.3f}", std::log2(coarse / fine) / 2));
    RecordProperty("error_" + g, fmt::format("{:.3g}", fine));
    EXPECT_GT(std::log2(middle / fine), 1.8) << g << ' ' << coarse << ' ' << middle << ' ' << fine;
    EXPECT_LT(fine, 1e-3) << g;
  }
}

const std::string charge = lit_charge("[0, 0, 0]", 0.0527);

TEST(Radial, DetonationReleasesExactlyItsEnergy) {
  for (const std::string& g : geometries) {
    Flow f(along_radius(g, 200, 0.2) + charge);
    const double energy = f.sums().U[Cons::rhoE], stored = stored_energy(f.m);
    EXPECT_NEAR(stored, f.sums().U[0] * f.m.setup.burn->q, 1e-12 * stored);
    while (f.m.state.t < f.m.setup.burn->t_all) f.steps(1);
    const Booked b = f.books.booked(f.m);
    EXPECT_NEAR(f.sums().U[Cons::rhoE] + b.cleaned[Cons::rhoE] - b.floor_energy - energy + stored_energy(f.m), stored,
                1e-13 * stored)
        << g;
  }
}

TEST(Radial, SameBitsOnThreadsAndWithRestSkipped) {
  expect_equal_on_threads(along_radius("spherical", 400, 0.4) + charge, 60);
  Flow skip(along_radius("spherical", 400, 0.4) + charge, true),
      all(along_radius("spherical", 400, 0.4) + charge, false);
  skip.steps(60, 5e-8), all.steps(60, 5e-8);
  EXPECT_EQ(skip.bits(), all.bits());
  EXPECT_LT(skip.books.booked(skip.m).updates, all.books.booked(all.m).updates);
}

}  // namespace
}  // namespace bw::cfd
