// SPDX-License-Identifier: Apache-2.0
// Limiter, flux and block kernel.
#include <gtest/gtest.h>

#include <cmath>

#include "cfd/eos/library.h"
#include "cfd/scheme/block_kernel.h"
#include "cfd/scheme/limiter.h"
#include "common/math/random.h"

namespace bw::cfd {
namespace {

TEST(Limiter, BetweenItsNeighboursAndHomogeneous) {
  const auto slope = [](double a, double b) { return MonotonizedCentral::slope(a, b); };
  EXPECT_EQ(slope(1, 1), 1);
  EXPECT_EQ(slope(1, 3), 2);
  EXPECT_EQ(slope(1, 10), 2);
  EXPECT_EQ(slope(-1, -10), -2);
  EXPECT_EQ(slope(-1, 10), 0);
  EXPECT_EQ(slope(0, 5), 0);
  EXPECT_EQ(slope(1024 * 0.3, 1024 * 0.7), 1024 * slope(0.3, 0.7));
}

struct Faces {
  double L[Prim::count] = {}, R[Prim::count] = {}, F[Cons::count] = {};
  Sound<double> left, right;
};
const Closure closure_of_two{1 / 0.3, 1 / 0.4};

Faces random_faces(uint64_t seed) {
  Faces f;
  const auto r = [&](int i) { return uniform01(seed, i, 0); };
  for (int q = 0; q < Prim::count; ++q) f.L[q] = 0.5 + r(q), f.R[q] = 0.5 + r(20 + q);
  f.L[Prim::alpha1] = r(40), f.R[Prim::alpha1] = r(41);
  for (int d = 0; d < 3; ++d) f.L[Prim::v + d] = 4 * r(50 + d) - 2, f.R[Prim::v + d] = 4 * r(60 + d) - 2;
  f.left = Sound<double>{0.5 + r(70), f.L[0] + f.L[1]};
  f.right = Sound<double>{0.5 + r(71), f.R[0] + f.R[1]};
  return f;
}
/// F(U) . e_x
void physical_flux(const double (&W)[Prim::count], double (&F)[Cons::count]) {
  const double rho = W[0] + W[1], u = W[Prim::v];
  const double E = closure_of_two.G(W[Prim::alpha1], W[Prim::arho1], W[Prim::arho2]) * W[Prim::p] + W[Prim::Pi] +
                   0.5 * rho * (u * u + W[3] * W[3] + W[4] * W[4]);
  F[0] = W[0] * u, F[1] = W[1] * u;
  F[2] = rho * u * u + W[Prim::p], F[3] = rho * u * W[3], F[4] = rho * u * W[4];
  F[5] = (E + W[Prim::p]) * u, F[6] = W[Prim::alpha1] * u;
}

TEST(Flux, ConsistentWithTheEquations) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    Faces f = random_faces(seed);
    double expected[Cons::count];
    physical_flux(f.L, expected);
    const double v = hllc<0>(f.L, f.L, f.left, f.left, closure_of_two, 1e30, f.F);
    EXPECT_NEAR(v, f.L[Prim::v], 1e-15);
    for (int q = 0; q < Cons::count; ++q) EXPECT_NEAR(f.F[q], expected[q], 1e-13) << q;
  }
}

TEST(Flux, MirrorImage) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    Faces f = random_faces(seed), m = f;
    std::swap(m.L, m.R), std::swap(m.left, m.right);
    m.L[Prim::v] *= -1, m.R[Prim::v] *= -1;
    hllc<0>(f.L, f.R, f.left, f.right, closure_of_two, 1e30, f.F);
    hllc<0>(m.L, m.R, m.left, m.right, closure_of_two, 1e30, m.F);
    for (int q = 0; q < Cons::count; ++q) EXPECT_NEAR(m.F[q], (q == Cons::mom ? 1 : -1) * f.F[q], 1e-12) << q;
  }
}

TEST(Flux, SupersonicIsUpwind) {
  Faces f = random_faces(3);
  f.L[Prim::v] = 9, f.R[Prim::v] = 8;
  double expected[Cons::count];
  physical_flux(f.L, expected);
  hllc<0>(f.L, f.R, f.left, f.right, closure_of_two, 1e30, f.F);
  for (int q = 0; q < Cons::count; ++q)
    EXPECT_EQ(f.F[q] == expected[q] || std::abs(f.F[q] - expected[q]) < 1e-13, true) << q;
}

TEST(Flux, ContactAtRestIsExactlyStill) {
  Faces f = random_faces(5);
  for (int d = 0; d < 3; ++d) f.L[Prim::v + d] = f.R[Prim::v + d] = 0;
  f.L[Prim::p] = f.R[Prim::p] = 101325;
  EXPECT_EQ((hllc<1>(f.L, f.R, f.left, f.right, closure_of_two, 1e30, f.F)), 0);
  for (int q = 0; q < Cons::count; ++q) EXPECT_EQ(f.F[q], q == Cons::mom_y ? 101325 : 0) << q;
}

TEST(Flux, AxesAreRotations) {
  const Faces f = random_faces(7);
  Faces x = f, y = f;
  for (int d = 0; d < 3; ++d)
    y.L[Prim::v + (d + 1) % 3] = f.L[Prim::v + d], y.R[Prim::v + (d + 1) % 3] = f.R[Prim::v + d];
  hllc<0>(x.L, x.R, x.left, x.right, closure_of_two, 1e30, x.F);
  hllc<1>(y.L, y.R, y.left, y.right, closure_of_two, 1e30, y.F);
  for (int d = 0; d < 3; ++d) EXPECT_EQ(y.F[Cons::mom + (d + 1) % 3], x.F[Cons::mom + d]);
  EXPECT_EQ(y.F[Cons::rhoE], x.F[Cons::rhoE]);
}

/// Smooth random-like data in all rows, ghosts and pads too.
void fill(Patch& p, double roughness) {
  const BlockShape& s = p.shape();
  for (int q = 0; q < Prim::stored; ++q)
    for (int k = -s.ghost(2); k < s.n[2] + s.ghost(2); ++k)
      for (int j = -s.ghost(1); j < s.n[1] + s.ghost(1); ++j)
        for (int i = -Patch::margin; i < s.n[0] + Patch::margin_right; ++i) {
          const double wave = std::sin(0.7 * i + 0.5 * j + 0.3 * k + q),
                       noise = uniform01(uint64_t(q), (k * 64 + j) * 64 + i, 1) - 0.5;
          const double f = 1 + 0.2 * wave + roughness * noise;
          constexpr double scale[Prim::stored] = {0.6, 0.6, 1, 0.5, -0.7, 1, 0.5, 0.1, 1.3, 1.4, 0.1};
          p.row(q, k, j)[i] = scale[q] * f;
        }
}

class KernelShape : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(KernelShape, PackIsAsDouble) {
  BlockShape s;
  s.n = GetParam();
  for (int d = 0; d < 3; ++d) s.used[d] = s.n[d] > 1, s.h[d] = 0.1 * (d + 1);
  Patch patch(s);
  fill(patch, 0.5);
  const auto compare = [&](auto flow) {
    using Flow = decltype(flow);
    BlockKernel<Flow, Pack> packs(s);
    BlockKernel<Flow, double> numbers(s);
    BlockChange a(s), b(s);
    a.book_sides = b.book_sides = 63;
    packs.advance(patch, flow, 0.01, a);
    numbers.advance(patch, flow, 0.01, b);
    EXPECT_EQ(a.scaled_cells, b.scaled_cells);
    for (int q = 0; q < Flow::n_flux; ++q) {
      const int r = flow.cons_row(q);
      for (int k = 0; k < s.n[2]; ++k)
        for (int j = 0; j < s.n[1]; ++j)
          for (int i = 0; i < s.n[0]; ++i)
            ASSERT_NEAR(a.row(r, k, j)[i], b.row(r, k, j)[i], 1e-13) << r << " at " << i << " " << j << " " << k;
      for (int side = 0; side < 6; ++side) EXPECT_NEAR(a.side[side][r], b.side[side][r], 1e-11);
      // what leaves the cells leaves through the sides
      double change = 0, sides = 0;
      for (int k = 0; k < s.n[2]; ++k)
        for (int j = 0; j < s.n[1]; ++j)
          for (int i = 0; i < s.n[0]; ++i) change += a.row(r, k, j)[i];
      for (int d = 0; d < 3; ++d) sides += a.side[2 * d][r] - a.side[2 * d + 1][r];
      if (r != Cons::alpha1) {
        EXPECT_NEAR(change, sides, 1e-11) << r;
      }
    }
  };
  compare(MixedFlow{closure_of_two});
  compare(MixedFlow{closure_of_two, Interface{1.6, {0, 0.1}, {false, true}, 2}});
  compare(GasFlow{2.5, 0.1, Prim::arho2});
}
INSTANTIATE_TEST_SUITE_P(Shapes, KernelShape,
                         testing::Values(std::array<int, 3>{16, 16, 16}, std::array<int, 3>{25, 1, 1},
                                         std::array<int, 3>{1, 9, 1}, std::array<int, 3>{1, 1, 7},
                                         std::array<int, 3>{10, 12, 1}, std::array<int, 3>{5, 1, 8},
                                         std::array<int, 3>{97, 4, 5}));

TEST(Kernel, UniformFlowDoesNotChange) {
  BlockShape s;
  s.n = {8, 8, 8};
  s.used = {true, true, true};
  Patch patch(s);
  constexpr double W[Prim::stored] = {0.7, 0.5, 100, 50, 20, 1e5, 0.3, 1e4, 340, 1.4e5, 3e3};
  for (int q = 0; q < Prim::stored; ++q)
    for (int k = -2; k < 10; ++k)
      for (int j = -2; j < 10; ++j)
        std::fill_n(patch.row(q, k, j) - Patch::margin, 8 + Patch::margin + Patch::margin_right, W[q]);
  BlockKernel<MixedFlow, Pack> kernel(s);
  BlockChange change(s);
  kernel.advance(patch, MixedFlow{closure_of_two}, 1e-3, change);
  for (int q = 0; q < Cons::count; ++q)
    for (int k = 0; k < 8; ++k)
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
          EXPECT_NEAR(change.row(q, k, j)[i], 0, q == Cons::rhoE ? 1e-8 : 1e-10)
              << q;  // of 1e7 and 1e5 that pass through
}

TEST(Interface, CurveHasTheCellsMean) {
  for (const double alpha : {0.001, 0.2, 0.5, 0.97})
    for (const double rising : {-1.0, 1.0})
      for (const double b : {0.02, 0.5, 1.6, 3.0}) {
        const SharpCurve<double> whole(alpha, rising, b, 1, 1), parts(alpha, rising, b, 0.3, 0.7);
        EXPECT_NEAR(whole.at_low, alpha, 1e-11);
        EXPECT_NEAR(whole.at_high, alpha, 1e-11);
        EXPECT_NEAR(0.3 * parts.at_low + 0.7 * parts.at_high, alpha, 1e-11);
        EXPECT_GE(rising * (parts.at_high - parts.at_low), 0);
      }
}

TEST(Positivity, FacesStayAboveTheirShare) {
  for (uint64_t seed = 0; seed < 200; ++seed) {
    double mean[Prim::count], half[Prim::count], slope[3][Prim::count];
    for (int q = 0; q < Prim::count; ++q) {
      mean[q] = uniform01(seed, q, 0);
      half[q] = mean[q] + 0.5 * (uniform01(seed, q, 1) - 0.5);
      for (int d = 0; d < 3; ++d) slope[d][q] = 2 * (uniform01(seed, q, 2 + d) - 0.5);
    }
    keep_faces_positive(MixedFlow{closure_of_two}, mean, half, slope);
    for (int q : {int(Prim::arho1), int(Prim::arho2), int(Prim::p), int(Prim::alpha1)})
      for (int d = 0; d < 3; ++d)
        for (const double side : {-0.5, 0.5}) {
          EXPECT_GE(half[q] + side * slope[d][q], 0.049 * mean[q]);
          if (q == Prim::alpha1) {
            EXPECT_GE(1 - half[q] - side * slope[d][q], 0.049 * (1 - mean[q]));
          }
        }
  }
}

}  // namespace
}  // namespace bw::cfd
