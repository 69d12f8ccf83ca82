// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/radial.h"

#include "cfd/scheme/radial.h"

namespace bw::cfd {

struct RadialKernels {
  explicit RadialKernels(int cells) : gas(cells), mixed(cells) {}
  RadialKernel<GasFlow, Pack> gas;
  RadialKernel<MixedFlow, Pack> mixed;
};

RadialSpace::RadialSpace() = default;
RadialSpace::RadialSpace(RadialSpace&&) noexcept = default;
RadialSpace::~RadialSpace() = default;
RadialKernels& RadialSpace::kernels(int cells) {
  if (!kernels_) kernels_ = std::make_unique<RadialKernels>(cells);
  return *kernels_;
}

void advance_radial(const Patch& patch, const Medium& medium, double dt, unsigned mirror, RadialSpace& space,
                    BlockChange& change) {
  RadialKernels& kernels = space.kernels(patch.shape().n[0]);
  const int m = patch.material;
  if (m != 0 && medium.is_gas[m - 1])
    kernels.gas.advance(patch, medium.gas[m - 1], dt, mirror, change);
  else
    kernels.mixed.advance(patch, mixed_flow(medium), dt, mirror, change);
}

}  // namespace bw::cfd
