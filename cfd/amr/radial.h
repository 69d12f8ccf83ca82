// SPDX-License-Identifier: Apache-2.0
// Blocks of shells: runs along a radius (cfd/scheme/radial.h).
#pragma once
#include <memory>

#include "cfd/medium.h"
#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

struct RadialKernels;
/// Work space of one thread; made at its first use.
class RadialSpace {
 public:
  RadialSpace();
  RadialSpace(RadialSpace&&) noexcept;
  ~RadialSpace();
  RadialKernels& kernels(int cells);

 private:
  std::unique_ptr<RadialKernels> kernels_;
};

/// What BlockKernel::advance does, for a block of shells: change = U_new - U. mirror: bit 0, 1: its lower, upper side
/// is a wall.
void advance_radial(const Patch& patch, const Medium& medium, double dt, unsigned mirror, RadialSpace& space,
                    BlockChange& change);

}  // namespace bw::cfd
