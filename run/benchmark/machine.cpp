// SPDX-License-Identifier: Apache-2.0
// What the machine can do: fused multiply-adds per second (double precision, all in registers) and the bandwidth of the triad
// a = b + s c on arrays far larger than the caches. Prints "fma_peak_1 <GF/s>" ... lines for 1 thread and for all of them.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "common/math/pack.h"
#include "common/parallel/loop.h"

namespace {

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Twelve independent chains hide the latency of the multiply-add; every chain converges, so nothing overflows.
double fma_work(int64_t trips, double seed) {
  constexpr int chains = 12;
  bw::Pack x[chains];
  for (int c = 0; c < chains; ++c) x[c] = bw::Pack(seed + 0.01 * c);
  const bw::Pack scale(0.999999), shift(1e-6);
  for (int64_t trip = 0; trip < trips; ++trip) {
#pragma GCC unroll 12
    for (int c = 0; c < chains; ++c) x[c] = x[c] * scale + shift;
  }
  bw::Pack sum(0.0);
  for (const bw::Pack& chain : x) sum += chain;
  return sum[0];
}

double fma_rate(int threads) {
  constexpr int64_t trips = 8'000'000;
  std::vector<double> sums(static_cast<size_t>(threads));
  double best = 0;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = now();
    bw::parallel_for_dynamic(threads, [&](int64_t i) { sums[size_t(i)] = fma_work(trips, double(i + repeat)); });
    best = std::max(best, 2.0 * 12 * bw::Pack::size * double(trips) * threads / (now() - start));
  }
  return sums[0] > -1 ? best : 0;
}

double triad_rate() {
  constexpr int64_t n = 16'000'000;
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 0;
  for (int repeat = 0; repeat < 6; ++repeat) {
    const double start = now();
    bw::parallel_for(n, [&](int64_t i) { a[size_t(i)] = b[size_t(i)] + 3.0 * c[size_t(i)]; });
    best = std::max(best, 24.0 * double(n) / (now() - start));  // as STREAM counts it
  }
  return a[n / 2] > 0 ? best : 0;
}

}  // namespace

int main() {
  const int threads = bw::thread_count();
  std::printf("threads %d\n", threads);
  omp_set_num_threads(1);
  std::printf("fma_peak_1 %.4f\n", fma_rate(1) / 1e9);
  std::printf("triad_1 %.4f\n", triad_rate() / 1e9);
  omp_set_num_threads(threads);
  std::printf("fma_peak_all %.4f\n", fma_rate(threads) / 1e9);
  std::printf("triad_all %.4f\n", triad_rate() / 1e9);
  return 0;
}
