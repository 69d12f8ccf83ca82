// SPDX-License-Identifier: Apache-2.0
// A run begins with what a run along a radius left: volumes, mass and energy kept, symmetry, clear errors.
#include <fmt/format.h>

#include <cmath>

#include "cfd/start/overlap.h"
#include "cfd/start/paint.h"
#include "tests/unit/cfd/whole_flow.h"

namespace bw::cfd {
namespace {

TEST(Overlap, BoxesInABallAddUpToIt) {
  for (const double R : {0.31, 0.5, 0.97, 1.0}) {
    double sum = 0;
    const int n = 7;
    for (int c = 0; c < n * n * n; ++c) {
      const Vec3 lower{-1.05 + 0.3 * (c % n), -1.0 + 0.3 * (c / n % n), -1.02 + 0.3 * (c / (n * n))};
      const double part = box_in_ball(lower, lower + Vec3{0.3, 0.3, 0.3}, R);
      EXPECT_GT(part, -1e-14);
      EXPECT_LT(part, 0.027 + 1e-14);
      sum += part;
    }
    EXPECT_NEAR(sum, 4 * M_PI / 3 * R * R * R, 1e-13);
  }
}

/// Midpoint rule over n^3 points.
double counted(const Vec3& lower, const Vec3& upper, double R, int n) {
  int inside = 0;
  const Vec3 d = (1.0 / n) * (upper - lower);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) inside += norm(lower + Vec3{(i + 0.5) * d.x, (j + 0.5) * d.y, (k + 0.5) * d.z}) < R;
  return inside * d.x * d.y * d.z;
}

TEST(Overlap, OneBoxAgainstCounting) {
  const Vec3 boxes[][2] = {{{0.1, 0.2, 0.3}, {0.9, 0.8, 0.7}},   {{-0.4, -0.3, -0.6}, {0.5, 0.2, 0.1}},
                           {{0.55, -0.1, 0.2}, {1.4, 0.3, 0.5}}, {{-2, -2, 0.2}, {2, 2, 0.6}},
                           {{0, 0, 0}, {0.999, 0.999, 0.999}},   {{0.57, 0.57, 0.57}, {0.6, 0.6, 0.6}}};
  for (const auto& box : boxes) {
    const double volume = (box[1].x - box[0].x) * (box[1].y - box[0].y) * (box[1].z - box[0].z);
    EXPECT_NEAR(box_in_ball(box[0], box[1], 1.0), counted(box[0], box[1], 1.0, 160), 2e-4 * volume);
  }
  const double a[2] = {-0.3, 0.2}, b[2] = {0.8, 1.7};
  double sum = 0;
  for (int i = 0; i < 200; ++i) {  // strips of the disc
    const double x = a[0] + (i + 0.5) * 1.1 / 200;
    sum += std::max(0.0, std::min(b[1], std::sqrt(1 - x * x)) - a[1]) * 1.1 / 200;
  }
  EXPECT_NEAR(rectangle_in_disc(a, b, 1.0), sum, 1e-5);
}

const std::string charge = lit_charge("[0, 0, 0]", 0.05);

/// A charge burnt through and a little more; its profile's file.
struct Left {
  std::string file, geometry;
  FluidSums sums;
  double shift = 0, t = 0;
  explicit Left(const std::string& kind, double radius = 0.3, bool whole = true) : geometry(kind) {
    Flow f(fmt::format("[fluid]\ngeometry = \"{}\"\nradius = {}\ncells = [300, 1, 1]\n", kind, radius) + charge);
    f.m.explosive_mass = f.sums().U[0];
    while (f.m.state.t < (whole ? 2 : 0.2) * f.m.setup.burn->t_all) f.steps(1);
    file = testing::TempDir() + fmt::format("/profile_{}_{}.h5", kind, getpid());
    write_profile(file, f.m);
    sums = f.sums(), shift = std::get<Jwl>(f.m.setup.medium.eos[0]).e_shift, t = f.m.state.t;
  }
  /// Energy as the profile has it.
  double energy() const { return sums.U[Cons::rhoE] + shift * sums.U[0]; }
  std::string table(const std::string& more) const {
    return fmt::format("[fluid.start_from]\nfile = \"{}\"\n", file) + more;
  }
};

/// The ball's share in the domain, its volume within the profile's domain and what the air around it has.
void expect_kept(const Flow& f, const Left& left, double share, double domain_1d) {
  const FluidSums s = f.sums();
  const double air = 101325 / 0.4, outside = s.volume - share * domain_1d;
  EXPECT_NEAR(s.U[0] / (share * left.sums.U[0]), 1, 1e-10);
  EXPECT_NEAR(s.U[1] / (share * left.sums.U[1] + 1.225 * outside), 1, 1e-10);
  EXPECT_NEAR(s.U[Cons::rhoE] / (share * left.energy() + air * outside), 1, 1e-10);
  EXPECT_NEAR(s.U[Cons::alpha1] / (share * left.sums.U[Cons::alpha1]), 1, 1e-10);
}

TEST(StartFrom, SphereInABoxKeepsMassAndEnergy) {
  const Left left("spherical");
  const double ball = 4 * M_PI / 3 * 0.3 * 0.3 * 0.3;
  Flow f(grid("[24, 20, 28]", "[0.8, 0.9, 0.9]") + air_and_tnt + left.table("centre = [0.37, 0.42, 0.5]\n"));
  expect_kept(f, left, 1, ball);
  EXPECT_LT(std::abs(f.sums().U[Cons::mom]), 1e-2 * std::sqrt(left.sums.U[Cons::rhoE] * left.sums.U[0]));
  f.steps(30);
  const Booked b = f.books.booked(f.m);
  EXPECT_EQ(b.floors, 0);
}

TEST(StartFrom, OctantIsAnEighthAndAsTheWhole) {
  const Left left("spherical");
  const double ball = 4 * M_PI / 3 * 0.3 * 0.3 * 0.3;
  Flow octant(grid("[16, 16, 16]", "[0.4, 0.4, 0.4]") + air_and_tnt + left.table(""));
  expect_kept(octant, left, 0.125, ball);
  Flow whole("[fluid]\nlower = [-0.4, -0.4, -0.4]\nupper = [0.4, 0.4, 0.4]\ncells = [32, 32, 32]\n" + air_and_tnt +
             left.table(""));
  expect_kept(whole, left, 1, ball);
  for (int i = 0; i < 16; i += 3)
    for (int j = 0; j < 16; j += 5) {
      const Vec3 x{(i + 0.5) * 0.025, (j + 0.5) * 0.025, 0.0625};
      const Forest::Cell a = octant.m.forest.find(x), b = whole.m.forest.find(x);
      const size_t ca = octant.m.forest.shape().at(a.k, a.j, a.i), cb = whole.m.forest.shape().at(b.k, b.j, b.i);
      for (int q = 0; q < Cons::count; ++q)
        EXPECT_NEAR(octant.m.state.block(a.block, q)[ca], whole.m.state.block(b.block, q)[cb],
                    1e-9 * (1 + std::abs(whole.m.state.block(b.block, Cons::rhoE)[cb])));
    }
}

TEST(StartFrom, OnAdaptiveBlocks) {
  const Left left("spherical");
  Flow f(
      "[fluid]\nlower = [0, 0, 0]\nupper = [0.8, 0.8, 0.8]\ncells = [16, 16, 16]\n[fluid.amr]\nlevels = 2\nblock = "
      "8\n" +
      air_and_tnt + left.table(""));
  expect_kept(f, left, 0.125, 4 * M_PI / 3 * 0.3 * 0.3 * 0.3);
}

TEST(StartFrom, CylinderAlongAnyAxis) {
  const Left left("cylindrical");
  for (const char* axis : {"x", "y", "z"}) {
    Flow f("[fluid]\nlower = [-0.4, -0.4, -0.4]\nupper = [0.4, 0.4, 0.4]\ncells = [16, 16, 16]\n" + air_and_tnt +
           left.table(fmt::format("axis = \"{}\"\ncentre = [0.02, 0.03, -0.01]\n", axis)));
    expect_kept(f, left, 0.8, M_PI * 0.09);
  }
}

TEST(StartFrom, CoarserShells) {
  for (const char* kind : {"spherical", "cylindrical"}) {
    const Left left(kind);
    Flow f(fmt::format("[fluid]\ngeometry = \"{}\"\nradius = 1\ncells = [210, 1, 1]\n", kind) + air_and_tnt +
           left.table(""));
    expect_kept(f, left, 1, kind[0] == 's' ? 4 * M_PI / 3 * 0.027 : M_PI * 0.09);
  }
}

TEST(StartFrom, WrongProfilesAreNamed) {
  const std::string box = grid("[16, 16, 16]", "[0.4, 0.4, 0.4]");
  const Left left("spherical");
  expect_wrong(box + air_and_tnt + "[fluid.start_from]\nfile = \"nowhere.h5\"\n", "nowhere.h5");
  expect_wrong(box + air_and_tnt + left.table("centre = [0.2, 0.2, 0.39]\n"), "z_upper");
  expect_wrong(grid("[16, 16, 16]", "[0.4, 0.4, 0.4]", "x_lower = \"outflow\"") + air_and_tnt + left.table(""),
               "x_lower");
  expect_wrong(with(box, "16]", "1]") + air_and_tnt + left.table(""), "cells in z");
  expect_wrong(box + with(air_and_tnt, "library = \"TNT\"", "library = \"Comp B\"") + left.table(""),
               "equation of state");
  expect_wrong(box + with(air_and_tnt, "name = \"TNT\"", "name = \"tnt\"") + left.table(""), "TNT and air");
  expect_wrong("[fluid]\ngeometry = \"cylindrical\"\nradius = 1\ncells = [210, 1, 1]\n" + air_and_tnt + left.table(""),
               "geometry");
  expect_wrong(box + charge + left.table(""), "start_from");
  expect_wrong(box + air_and_tnt + Left("spherical", 0.3, false).table(""), "burnt");
}

}  // namespace
}  // namespace bw::cfd
