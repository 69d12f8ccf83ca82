// SPDX-License-Identifier: Apache-2.0
// The kernels of blocks that hold some of three or more materials behind one door: compiled once per number of
// materials, one call per block.
#pragma once
#include <memory>

#include "cfd/mix/list.h"
#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

/// One per thread; patch and change as BlockKernel has them.
class ManyKernel {
 public:
  virtual ~ManyKernel() = default;
  virtual void advance(const Patch& patch, double dt, BlockChange& change, const CutFaces* cut) = 0;
  /// Of shells; mirror as in ShellRow::fill.
  virtual void advance_radial(const Patch& patch, double dt, unsigned mirror, BlockChange& change) = 0;
};

/// mixture: of three or more.
std::unique_ptr<ManyKernel> make_many_kernel(const Mixture& mixture, const BlockShape& shape);

}  // namespace bw::cfd
