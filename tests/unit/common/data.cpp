// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "common/data/components.h"
#include "common/data/csr.h"
#include "common/data/field.h"
#include "common/math/random.h"
#include "common/parallel/loop.h"

using namespace bw;

TEST(Csr, rows_keep_the_order_of_adding) {
  const auto csr = Csr<int>::build(4, [](auto&& add) {
    add(2, 7);
    add(0, 1);
    add(2, 5);
    add(3, 9);
    add(2, 6);
  });
  EXPECT_EQ(csr.rows(), 4);
  EXPECT_EQ(csr.size(), 5);
  EXPECT_EQ(csr[1].size(), 0u);
  EXPECT_EQ(std::vector<int>(csr[2].begin(), csr[2].end()), (std::vector<int>{7, 5, 6}));
  EXPECT_EQ(csr.start(3), 4);
  EXPECT_EQ(Csr<int>().rows(), 0);
}

TEST(Components, labels_do_not_depend_on_the_order_of_joining) {
  constexpr int64_t n = 2000;
  std::vector<std::pair<int64_t, int64_t>> links;
  for (uint64_t i = 0; i < 900; ++i) links.push_back({int64_t(uniform01(1, i) * n), int64_t(uniform01(2, i) * n)});
  Components forward(n), backward(n);
  for (const auto& [a, b] : links) forward.join(a, b);
  for (auto it = links.rbegin(); it != links.rend(); ++it) backward.join(it->second, it->first);
  const auto labels = forward.labels();
  EXPECT_EQ(labels.of, backward.labels().of);
  // against repeated sweeps of minima
  std::vector<int64_t> low(n);
  for (int64_t i = 0; i < n; ++i) low[size_t(i)] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : links) {
      const int64_t m = std::min(low[size_t(a)], low[size_t(b)]);
      changed = changed || low[size_t(a)] != m || low[size_t(b)] != m;
      low[size_t(a)] = low[size_t(b)] = m;
    }
  }
  std::map<int64_t, int> number;
  for (int64_t i = 0; i < n; ++i) {
    const int expected = number.try_emplace(low[size_t(i)], int(number.size())).first->second;
    ASSERT_EQ(labels.of[size_t(i)], expected);
    ASSERT_EQ(forward.find(i), low[size_t(i)]);
  }
  EXPECT_EQ(labels.count, int(number.size()));
}

TEST(Field, is_aligned_and_typed) {
  Field<double, NodeId> f(5, 2.5);
  f.push_back(3);
  EXPECT_EQ(f[NodeId(5)], 3);
  EXPECT_EQ(f[NodeId(4)], 2.5);
  EXPECT_EQ(reinterpret_cast<uintptr_t>(f.data()) % 64, 0u);
  EXPECT_FALSE(NodeId().valid());
}

TEST(Loop, reductions_are_bit_equal_for_any_number_of_threads) {
  const auto value = [](int64_t i) { return uniform01(3, uint64_t(i)) - 0.5; };
  const int before = thread_count();
  std::set<double> sums;
  for (const int threads : {1, 2, 3, 7}) {
    set_thread_count(threads);
    sums.insert(parallel_sum(100001, value));
    EXPECT_EQ(parallel_max(100001, -1.0, value), parallel_max(100001, -2.0, value));
    std::vector<int> hits(5000);
    parallel_for(5000, [&](int64_t i) { ++hits[size_t(i)]; });
    parallel_for_dynamic(5000, [&](int64_t i) { ++hits[size_t(i)]; });
    EXPECT_EQ(hits, std::vector<int>(5000, 2));
  }
  set_thread_count(before);
  EXPECT_EQ(sums.size(), 1u);
}

TEST(Random, is_uniform_and_a_function_of_its_arguments) {
  double sum = 0, square = 0;
  for (uint64_t i = 0; i < 100000; ++i) {
    const double u = uniform01(5, i);
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    sum += u;
    square += u * u;
  }
  EXPECT_NEAR(sum / 1e5, 0.5, 0.005);
  EXPECT_NEAR(square / 1e5, 1.0 / 3, 0.005);
  EXPECT_EQ(uniform01(1, 2, 3), uniform01(1, 2, 3));
  EXPECT_NE(uniform01(1, 2, 3), uniform01(1, 3, 2));
}
