// SPDX-License-Identifier: Apache-2.0
// Packs, tensors and roots: against std and against algebra; a pack does lane by lane what a double does, to the last
// bit.
#include <gtest/gtest.h>

#include <cmath>

#include "common/math/pack.h"
#include "common/math/random.h"
#include "common/math/roots.h"
#include "common/math/tensor.h"

using namespace bw;

namespace {

double between(double lo, double hi, uint64_t i, uint64_t event = 0) {
  return lo + (hi - lo) * uniform01(11, i, event);
}
double power_between(double lo, double hi, uint64_t i) { return std::pow(10.0, between(lo, hi, i)); }

/// f of `count` random numbers as packs and as doubles: the same bits; against `exact`: within `tolerance` relatively.
template <class F, class G, class X>
void check_function(const F& f, const G& exact, const X& argument, double tolerance) {
  for (uint64_t i = 0; i < 100000; i += Pack::size) {
    Pack x;
    for (int l = 0; l < Pack::size; ++l) x.set(l, argument(i + uint64_t(l)));
    const Pack y = f(x);
    for (int l = 0; l < Pack::size; ++l) {
      ASSERT_EQ(y[l], f(x[l])) << "at " << x[l];
      ASSERT_NEAR(y[l], exact(x[l]), tolerance * std::abs(exact(x[l]))) << "at " << x[l];
    }
  }
}

Mat3 random_matrix(uint64_t i) {
  Mat3 m;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) m(a, b) = between(-1, 1, i, uint64_t(3 * a + b)) + (a == b ? 2 : 0);
  return m;
}

}  // namespace

TEST(Pack, exp_is_std_exp) {
  const auto f = [](auto x) { return bw::exp(x); };
  check_function(
      f, [](double x) { return std::exp(x); }, [](uint64_t i) { return between(-690, 690, i); }, 1e-15);
  check_function(
      f, [](double x) { return std::exp(x); }, [](uint64_t i) { return between(-1, 1, i); }, 1e-15);
  EXPECT_EQ(bw::exp(0.0), 1.0);
}

TEST(Pack, log_is_std_log) {
  const auto f = [](auto x) { return bw::log(x); };
  check_function(
      f, [](double x) { return std::log(x); }, [](uint64_t i) { return power_between(-300, 300, i); }, 2e-15);
  check_function(
      f, [](double x) { return std::log(x); }, [](uint64_t i) { return between(0.5, 2, i); }, 2e-15);
  EXPECT_EQ(bw::log(1.0), 0.0);
}

TEST(Pack, rcbrt_is_inverse_cube_root) {
  const auto f = [](auto x) { return rcbrt(x); };
  check_function(
      f, [](double x) { return 1 / std::cbrt(x); }, [](uint64_t i) { return power_between(-30, 30, i); }, 1e-15);
}

TEST(Pack, sqrt_min_max_abs_select_match_double) {
  const auto same = [](double x) { return x; };
  check_function([](auto x) { return bw::sqrt(bw::abs(x)); }, [](double x) { return std::sqrt(std::abs(x)); },
                 [](uint64_t i) { return between(-9, 9, i); }, 0);
  check_function(
      [](auto x) {
        using T = decltype(x);
        const T one(1.0);
        return select(x < one, bw::min(x, one), bw::max(x, one));
      },
      same, [](uint64_t i) { return between(-9, 9, i); }, 0);
}

TEST(Pack, masks) {
  Pack a(1.0), b(1.0);
  b.set(1, 3.0);
  EXPECT_TRUE(any(a < b));
  EXPECT_FALSE(all(a < b));
  EXPECT_TRUE(all((a < b) | (a >= b)));
  EXPECT_FALSE(any((a < b) & !(a < b)));
  EXPECT_TRUE((a < b)[1]);
  EXPECT_FALSE((a < b)[0]);
  double memory[Pack::size + 1] = {};
  b.store(memory + 1);  // any alignment
  EXPECT_EQ(Pack::load(memory + 1)[1], 3.0);
}

TEST(Tensor, inverse_determinant_cofactor) {
  for (uint64_t i = 0; i < 200; ++i) {
    const Mat3 a = random_matrix(i), b = random_matrix(i + 1000), unit_error = a * inverse(a) - Mat3::identity();
    for (int r = 0; r < 3; ++r) EXPECT_LT(norm(unit_error.row[r]), 1e-13);
    EXPECT_NEAR(det(a * b), det(a) * det(b), 1e-12 * std::abs(det(a) * det(b)));
    EXPECT_NEAR(det(cofactor(a)), det(a) * det(a), 1e-12 * det(a) * det(a));
    EXPECT_EQ(trace(transpose(a)), trace(a));
    const Vec3 u = a.row[0], v = b.row[1];
    EXPECT_NEAR(dot(cross(u, v), u), 0, 1e-14);
    EXPECT_NEAR(dot(cross(u, v), cross(u, v)), dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v), 1e-12);
  }
}

TEST(Tensor, symmetric_agrees_with_full) {
  for (uint64_t i = 0; i < 200; ++i) {
    const Mat3 m = random_matrix(i), s = m * transpose(m);
    const Sym3 a{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)};
    EXPECT_NEAR(det(a), det(s), 1e-11 * det(s));
    EXPECT_NEAR(contract(a, a), trace(s * s), 1e-12 * trace(s * s));
    EXPECT_NEAR(trace(deviator(a)), 0, 1e-13 * trace(a));
    EXPECT_LT(norm(a * m.row[0] - s * m.row[0]), 1e-13 * norm(s * m.row[0]));
  }
}

TEST(Tensor, pack_does_what_double_does) {
  Mat<Pack> p;
  Mat3 lane[Pack::size];
  for (int l = 0; l < Pack::size; ++l) {
    lane[l] = random_matrix(uint64_t(l));
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) p(a, b).set(l, lane[l](a, b));
  }
  const Pack d = det(p);
  for (int l = 0; l < Pack::size; ++l) EXPECT_NEAR(d[l], det(lane[l]), 1e-15 * 30);
}

TEST(Roots, newton_and_bisection_find_the_root) {
  const auto cube = [](double x) { return std::pair(x * x * x - 2, 3 * x * x); };
  const Root r = find_root(cube, 0, 2, 1e-14);
  EXPECT_TRUE(r.converged);
  EXPECT_NEAR(r.x, std::cbrt(2.0), 1e-14);
  EXPECT_LT(r.steps, 15);
  const auto falling = [](double x) { return std::pair(std::exp(-x) - 0.25, -std::exp(-x)); };
  EXPECT_NEAR(find_root(falling, 0, 100, 1e-13).x, std::log(4.0), 1e-12);
  const auto flat = [](double x) { return std::pair(std::pow(x - 1, 3), 3 * (x - 1) * (x - 1)); };  // Newton crawls
  EXPECT_NEAR(find_root(flat, 0, 3, 1e-10).x, 1, 1e-8);
  const auto circling = [](double x) {
    return std::pair(std::atan(x), 1 / (1 + x * x));
  };  // Newton diverges from |x| > 1.39
  EXPECT_NEAR(find_root(circling, -50, 80, 1e-12).x, 0, 1e-12);
  EXPECT_FALSE(find_root(cube, 3, 4, 1e-12).converged);
  EXPECT_FALSE(find_root([](double) { return std::pair(std::nan(""), 1.0); }, 0, 1, 1e-12).converged);
}

TEST(Roots, fixed_trips_for_packs) {
  Pack target;
  for (int l = 0; l < Pack::size; ++l) target.set(l, 0.5 + 3 * l);
  const auto f = [](const auto& c) { return [c](const auto& x) { return std::pair(x * x * x - c, 3.0 * x * x); }; };
  const Pack root = newton_in_bracket(f(target), Pack(0.0), Pack(4.0), Pack(0.1), 12);
  for (int l = 0; l < Pack::size; ++l) {
    EXPECT_NEAR(root[l], std::cbrt(target[l]), 1e-14);
    EXPECT_NEAR(root[l], newton_in_bracket(f(target[l]), 0.0, 4.0, 0.1, 12), 1e-15);
  }
  EXPECT_NEAR(newton_in_bracket(f(1000.0), 0.0, 4.0, 1.0, 60), 4.0, 1e-12);  // the root lies above: the upper end
}
