// SPDX-License-Identifier: Apache-2.0
#include "cfd/scheme/many_kernel.h"

#include <optional>

#include "cfd/scheme/radial.h"
#include "common/app/error.h"

namespace bw::cfd {
namespace {

template <int K>
class Kernel final : public ManyKernel {
 public:
  Kernel(const ManyMaterials<K>& mix, const BlockShape& shape) : flow_(mix) {
    if (shape.radial())
      shells_.emplace(shape.n[0]);
    else
      block_.emplace(shape);
  }
  void advance(const Patch& patch, double dt, BlockChange& change, const CutFaces* cut) override {
    block_->advance(patch, flow_, dt, change, cut);
  }
  void advance_radial(const Patch& patch, double dt, unsigned mirror, BlockChange& change) override {
    shells_->advance(patch, flow_, dt, mirror, change);
  }

 private:
  ManyFlow<K> flow_;
  std::optional<BlockKernel<ManyFlow<K>, Pack>> block_;
  std::optional<RadialKernel<ManyFlow<K>, Pack>> shells_;
};

}  // namespace

std::unique_ptr<ManyKernel> make_many_kernel(const Mixture& mixture, const BlockShape& shape) {
  return std::visit(
      [&]<class Mix>(const Mix& mix) -> std::unique_ptr<ManyKernel> {
        if constexpr (Mix::materials > 2) return std::make_unique<Kernel<Mix::materials>>(mix, shape);
        BW_CHECK(false);
      },
      mixture);
}

}  // namespace bw::cfd
