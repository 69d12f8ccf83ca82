// SPDX-License-Identifier: Apache-2.0
// What the integration points of a body remember: [block][8][components][lanes], for this rank's blocks. In double
// precision, or rounded to single: half the memory, and stresses to about 1e-7 of the elastic moduli.
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/data/field.h"
#include "common/math/pack.h"

namespace bw::csd {

class PointHistory {
 public:
  PointHistory() = default;
  PointHistory(int blocks, int components, bool single)
      : block_size_(size_t(8 * components * lanes)), uniform_(size_t(blocks), 0) {
    (single ? single_.resize(block_size_ * size_t(blocks)) : double_.resize(block_size_ * size_t(blocks)));
  }
  /// Numbers of a block; block_size() of them.
  size_t block_size() const { return block_size_; }
  /// The block in a row (Blocks::row_of): where it is stored, or a copy in `buffer` of block_size() doubles.
  const double* read(int row, double* buffer) const {
    if (single_.empty()) return double_.data() + size_t(row) * block_size_;
    std::copy_n(single_.data() + size_t(row) * block_size_, block_size_, buffer);
    return buffer;
  }
  double* read(int row, double* buffer) { return const_cast<double*>(std::as_const(*this).read(row, buffer)); }
  /// What read() gave has changed.
  void write(int row, const double* from) {
    if (!single_.empty()) std::copy_n(from, block_size_, single_.data() + size_t(row) * block_size_);
    uniform_[size_t(row)] = 0;
  }
  /// The block's elements are parallelepipeds in which nothing has flowed: all their points remember what the first
  /// does.
  bool is_uniform(int row) const { return uniform_[size_t(row)]; }
  void set_uniform(int row) { uniform_[size_t(row)] = 1; }
  /// Calls change(double*) for a block and keeps the result.
  template <class Change>
  void change(int row, const Change& change) {
    Aligned<double> buffer(single_.empty() ? 0 : block_size_);
    double* values = read(row, buffer.data());
    change(values);
    write(row, values);
  }

  /// In a checkpoint (csd/archive.h).
  template <class A>
  void keep(A& a, const std::string& name, int body) {
    a.body_blocks(name, body, double_, block_size_);
    a.body_blocks(name + "_single", body, single_, block_size_);
    a.body_blocks(name + "_uniform", body, uniform_, 1);
  }

 private:
  size_t block_size_ = 0;
  Aligned<double> double_;
  Aligned<float> single_;  // one of the two is empty
  std::vector<char> uniform_;
};

/// Room for a block's history where it is not stored in double precision.
template <class M>
struct HistoryBuffer {
  alignas(64) double values[8 * M::components * lanes];
};

}  // namespace bw::csd
