// SPDX-License-Identifier: Apache-2.0
// Connected components by union-find. The result does not depend on the order in which things were joined.
#pragma once
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace bw {

class Components {
 public:
  explicit Components(int64_t n) : parent_(size_t(n)) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The smallest member of i's component.
  int64_t find(int64_t i) {
    while (parent_[size_t(i)] != i) i = parent_[size_t(i)] = parent_[size_t(parent_[size_t(i)])];
    return i;
  }
  bool join(int64_t i, int64_t j) {
    i = find(i);
    j = find(j);
    if (i == j) return false;
    if (j < i) std::swap(i, j);
    parent_[size_t(j)] = i;
    return true;
  }
  struct Labels {
    std::vector<int32_t> of;  ///< [n] 0, 1, 2 ... in the order of the components' smallest members
    int32_t count = 0;
  };
  Labels labels() {
    Labels l;
    l.of.resize(parent_.size());
    for (int64_t i = 0; i < int64_t(parent_.size()); ++i) {
      const int64_t first = find(i);
      l.of[size_t(i)] = first == i ? l.count++ : l.of[size_t(first)];
    }
    return l;
  }

 private:
  std::vector<int64_t> parent_;  ///< never above its index
};

}  // namespace bw
