// SPDX-License-Identifier: Apache-2.0
// Sums that are the same bits in any order and for any number of ranks: integers in units of 2^-80 (8e-25).
#pragma once
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "common/parallel/mpi.h"

namespace bw {

class FixedSum {
 public:
  /// Beyond 7e13, and what is no number, leaves a sum that is no number.
  FixedSum& operator+=(double a) {
    if (!(std::abs(a) < 0x1p46) || __builtin_add_overflow(units_, Wide(std::ldexp(a, 80)), &units_)) is_lost_ = true;
    return *this;
  }
  FixedSum& operator+=(const FixedSum& b) {
    is_lost_ = __builtin_add_overflow(units_, b.units_, &units_) || is_lost_ || b.is_lost_;
    return *this;
  }
  double value() const { return is_lost_ ? std::numeric_limits<double>::quiet_NaN() : std::ldexp(double(units_), -80); }

  /// Each becomes the sum of all ranks'. Collective.
  static void sum(const Comm& comm, std::span<FixedSum> sums) {
    if (comm.size() == 1) return;
    constexpr int parts = 5;  // four of 32 bits, and whether it is lost: whole numbers, which doubles add exactly
    std::vector<double> all;
    for (const FixedSum& s : sums) {
      for (int i = 0; i < 3; ++i) all.push_back(double(uint32_t(s.units_ >> (32 * i))));
      all.push_back(double(int32_t(s.units_ >> 96)));
      all.push_back(s.is_lost_);
    }
    comm.sum(all);
    for (size_t k = 0; k < sums.size(); ++k) {
      Wide units = 0;
      bool is_lost = all[parts * k + 4] > 0;
      for (int i = 3; i >= 0; --i) {
        is_lost |= __builtin_mul_overflow(units, Wide(1) << 32, &units);
        is_lost |= __builtin_add_overflow(units, Wide(all[parts * k + size_t(i)]), &units);
      }
      sums[k].units_ = units, sums[k].is_lost_ = is_lost;
    }
  }

 private:
  __extension__ typedef __int128 Wide;
  Wide units_ = 0;
  bool is_lost_ = false;
};

}  // namespace bw
