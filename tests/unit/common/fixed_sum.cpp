// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/parallel/fixed_sum.h"

namespace bw {
namespace {

TEST(FixedSum, AnyOrderGivesTheSameBits) {
  std::mt19937_64 dice(1);
  std::uniform_real_distribution<double> exponent(-20, 8), sign(-1, 1);
  std::vector<double> terms;
  for (int i = 0; i < 10000; ++i) terms.push_back(sign(dice) * std::pow(10, exponent(dice)));
  const auto sum_of = [&] {
    FixedSum parts[3];
    for (size_t i = 0; i < terms.size(); ++i) parts[i % 3] += terms[i];
    parts[0] += parts[1], parts[0] += parts[2];
    return parts[0].value();
  };
  const double first = sum_of();
  long double exact = 0;
  for (const double a : terms) exact += a;
  EXPECT_NEAR(first, double(exact), 1e-9 * std::abs(double(exact)));
  for (int i = 0; i < 5; ++i) {
    std::shuffle(terms.begin(), terms.end(), dice);
    EXPECT_EQ(sum_of(), first);
  }
}

TEST(FixedSum, SmallBesideLargeAndWhatIsNoNumber) {
  FixedSum sum;
  for (const double a : {1e13, 1.0, -1e13, -0x1p-79}) sum += a;
  EXPECT_EQ(sum.value(), 1.0);  // 1 - 2^-79, rounded
  FixedSum large;
  large += 1e15;
  EXPECT_TRUE(std::isnan(large.value()));
  FixedSum too_large;  // of addends that are not
  too_large += 0x1.fp45, too_large += 0x1.fp45, too_large += 0x1.fp45;
  EXPECT_TRUE(std::isnan(too_large.value()));
  FixedSum lost = sum;
  lost += std::nan("");
  EXPECT_TRUE(std::isnan(lost.value()));
}

}  // namespace
}  // namespace bw
