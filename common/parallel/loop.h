// SPDX-License-Identifier: Apache-2.0
// Thread-parallel loops: the only home of OpenMP pragmas. Every result is the same for any number of threads: loops
// write disjoint places, sums are made per fixed chunk and added in chunk order.
#pragma once
#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace bw {

inline int thread_count() { return omp_get_max_threads(); }
inline void set_thread_count(int threads) { omp_set_num_threads(threads); }

/// Light items from which on it pays to wake threads that have gone to sleep, as they do while a program waits.
constexpr int64_t worth_waking = 65536;

/// body(i) for i in [0, n), iterations independent; on all threads if there are more than `alone`.
template <class Body>
void parallel_for(int64_t n, const Body& body, int64_t alone = 256) {
#pragma omp parallel for schedule(static) if (n > alone)
  for (int64_t i = 0; i < n; ++i) body(i);
}

/// The same for few, heavy, uneven iterations (blocks of cells, chunks of elements).
template <class Body>
void parallel_for_dynamic(int64_t n, const Body& body) {
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (int64_t i = 0; i < n; ++i) body(i);
}

/// The same, with a work space per thread: body(i, space[thread]).
template <class Space, class Body>
void parallel_for_dynamic(int64_t n, std::vector<Space>& space, const Body& body) {
  if (int(space.size()) < thread_count()) space.resize(size_t(thread_count()));
#pragma omp parallel for schedule(dynamic, 1) if (n > 1)
  for (int64_t i = 0; i < n; ++i) body(i, space[size_t(omp_get_thread_num())]);
}

/// main on this thread, which alone may call MPI, while other runs on another one, if there is one; for n light items.
template <class Main, class Other>
void beside(int64_t n, const Main& main, const Other& other) {
#pragma omp parallel if (n > worth_waking)
  {
    if (omp_get_thread_num() == omp_get_num_threads() - 1) other();
    if (omp_get_thread_num() == 0) main();
  }
}

/// Fold of value(i) over [0, n) with combine(a, b), bit-equal for any number of threads.
template <class T, class Value, class Combine>
T parallel_reduce(int64_t n, T identity, const Value& value, const Combine& combine) {
  constexpr int64_t chunk = 1024;
  const int64_t chunks = (n + chunk - 1) / chunk;
  std::vector<T> part(size_t(chunks), identity);
#pragma omp parallel for schedule(static) if (chunks > 1)
  for (int64_t c = 0; c < chunks; ++c) {
    T sum = identity;
    for (int64_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i) sum = combine(sum, value(i));
    part[size_t(c)] = sum;
  }
  T total = identity;
  for (const T& p : part) total = combine(total, p);
  return total;
}
/// The same, bit for bit, as if all values had been stored first: none is fused with the sum.
template <class T, class Value, class Combine>
T parallel_reduce_stored(int64_t n, T identity, const Value& value, const Combine& combine) {
  constexpr int64_t chunk = 1024;
  const int64_t chunks = (n + chunk - 1) / chunk;
  std::vector<T> part(size_t(chunks), identity);
#pragma omp parallel if (chunks > 1)
  {
    std::vector<T> values(size_t(std::min(n, chunk)), identity);
#pragma omp for schedule(static)
    for (int64_t c = 0; c < chunks; ++c) {
      const int64_t first = c * chunk, count = std::min(n - first, chunk);
      for (int64_t i = 0; i < count; ++i) values[size_t(i)] = value(first + i);
      T sum = identity;
      for (int64_t i = 0; i < count; ++i) sum = combine(sum, values[size_t(i)]);
      part[size_t(c)] = sum;
    }
  }
  T total = identity;
  for (const T& p : part) total = combine(total, p);
  return total;
}
template <class Value>
double parallel_sum(int64_t n, const Value& value) {
  return parallel_reduce(n, 0.0, value, [](double a, double b) { return a + b; });
}
template <class Value>
double parallel_min(int64_t n, double identity, const Value& value) {
  return parallel_reduce(n, identity, value, [](double a, double b) { return a < b ? a : b; });
}
template <class Value>
double parallel_max(int64_t n, double identity, const Value& value) {
  return parallel_reduce(n, identity, value, [](double a, double b) { return a > b ? a : b; });
}

}  // namespace bw
