// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/cut_scheme.h"

#include "cfd/embed/cut_kernel.h"

namespace bw::cfd {
namespace {

template <class Eos>
class Scheme final : public CutScheme {
 public:
  Scheme(const Eos& eos, const typename Eos::Flow& flow, const BlockShape& shape, WallTreatment treatment)
      : eos_(eos), flow_(flow), kernel_(shape, treatment) {}

  const CutFaces& prepare(Patch& patch, const PatchCuts& cuts, double dt) override {
    return kernel_.prepare(patch, cuts, flow_, eos_, dt);
  }
  void correct(BlockChange& change, WallExchange& exchange, std::vector<LinkLoad>* links) override {
    kernel_.correct(change, exchange, links);
  }
  void begin(const Patch& patch, const PatchCuts& cuts, double dt) override {
    kernel_.begin(patch, cuts, flow_, eos_, dt);
  }
  WallLoad load(const Index3& cell, const Vec3& x, const Vec3& n, const Vec3& v) override {
    return kernel_.load(cell, x, n, v);
  }

 private:
  Eos eos_;
  typename Eos::Flow flow_;
  CutKernel<Eos> kernel_;
};

}  // namespace

std::unique_ptr<CutScheme> make_cut_scheme(const Mixture& mixture, const BlockShape& shape, WallTreatment treatment) {
  return std::visit(
      [&]<class Mix>(const Mix& mix) -> std::unique_ptr<CutScheme> {
        using Eos = MixtureAtWall<Mix>;
        if constexpr (Mix::materials > 2)
          return std::make_unique<Scheme<Eos>>(Eos{mix}, ManyFlow<Mix::materials>(mix), shape, treatment);
        else
          return std::make_unique<Scheme<Eos>>(Eos{mix}, MixedFlow{mix.closure()}, shape, treatment);
      },
      mixture);
}

std::unique_ptr<CutScheme> make_cut_scheme(const GasFlow& gas, const BlockShape& shape, WallTreatment treatment) {
  return std::make_unique<Scheme<GasAtWall>>(GasAtWall{gas.over_G, gas.Pi}, gas, shape, treatment);
}

}  // namespace bw::cfd
