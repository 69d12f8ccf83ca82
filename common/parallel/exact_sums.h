// SPDX-License-Identifier: Apache-2.0
// Several exact sums over one long loop, on all threads.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/math/sum.h"
#include "common/parallel/loop.h"

namespace bw {

/// n sums over [0, count), light ones: add(i, sums) adds the terms of i to plain sums of a few. Bit-equal for any
/// number of threads; of at most `alone` terms no other one is woken.
template <size_t n, class Add>
std::array<double, n> exact_sums(size_t count, const Add& add, int64_t alone = worth_waking) {
  constexpr size_t chunk = 64 * terms_at_once;
  std::vector<std::array<ExactSum, n>> parts((count + chunk - 1) / chunk);
  const auto sum_chunk = [&](int64_t c) {
    const size_t end = std::min(count, size_t(c + 1) * chunk);
    std::array<ExactSum, n> exact;
    for (size_t begin = size_t(c) * chunk; begin < end; begin += terms_at_once) {
      std::array<double, n> plain{};
      for (size_t i = begin; i < std::min(begin + terms_at_once, end); ++i) add(i, plain);
      for (size_t k = 0; k < n; ++k) exact[k] += plain[k];
    }
    parts[size_t(c)] = exact;
  };
  parallel_for(int64_t(parts.size()), sum_chunk, alone / int64_t(chunk));
  std::array<ExactSum, n> exact;
  for (const auto& part : parts)
    for (size_t k = 0; k < n; ++k) exact[k] += part[k].value();
  std::array<double, n> sums;
  for (size_t k = 0; k < n; ++k) sums[k] = exact[k].value();
  return sums;
}

/// Three of such sums as a vector, and the other way round.
template <size_t n>
Vec3 vector_at(const std::array<double, n>& sums, size_t first) {
  return {sums[first], sums[first + 1], sums[first + 2]};
}
template <size_t n>
void add_at(std::array<double, n>& sums, size_t first, const Vec3& a) {
  sums[first] += a.x, sums[first + 1] += a.y, sums[first + 2] += a.z;
}

}  // namespace bw
