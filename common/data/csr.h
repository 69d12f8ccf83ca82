// SPDX-License-Identifier: Apache-2.0
// Lists of different length, one after the other in one array: elements of a node, neighbours of a block.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace bw {

template <class Item>
class Csr {
 public:
  Csr() = default;
  /// Visits twice, to count and to fill: visit(add) calls add(row, item) for each item, both times the same. Items of a
  /// row keep the order in which they were added.
  ///
  ///   auto elems_of_node = Csr<ElemId>::build(nodes, [&](auto&& add) {
  ///     for (int e = 0; e < elems; ++e)
  ///       for (NodeId n : hex[e]) add(n, ElemId(e));
  ///   });
  template <class Visit>
  static Csr build(int64_t rows, const Visit& visit) {
    Csr csr;
    csr.start_.assign(size_t(rows) + 1, 0);
    visit([&](int64_t row, const Item&) { ++csr.start_[size_t(row) + 1]; });
    for (size_t r = 0; r < size_t(rows); ++r) csr.start_[r + 1] += csr.start_[r];
    csr.items_.resize(size_t(csr.start_.back()));
    std::vector<int64_t> next(csr.start_.begin(), csr.start_.end() - 1);
    visit([&](int64_t row, const Item& item) { csr.items_[size_t(next[size_t(row)]++)] = item; });
    return csr;
  }

  int64_t rows() const { return int64_t(start_.size()) - 1; }
  int64_t size() const { return int64_t(items_.size()); }
  std::span<const Item> operator[](int64_t row) const {
    return {items_.data() + start_[size_t(row)], size_t(start_[size_t(row) + 1] - start_[size_t(row)])};
  }
  std::span<Item> operator[](int64_t row) {
    return {items_.data() + start_[size_t(row)], size_t(start_[size_t(row) + 1] - start_[size_t(row)])};
  }
  /// Where a row begins in items().
  int64_t start(int64_t row) const { return start_[size_t(row)]; }
  std::span<const Item> items() const { return items_; }

 private:
  std::vector<int64_t> start_{0};
  std::vector<Item> items_;
};

}  // namespace bw
