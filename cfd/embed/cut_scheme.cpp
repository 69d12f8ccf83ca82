// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/cut_scheme.h"

#include "cfd/embed/cut_kernel.h"
#include "cfd/embed/refill.h"

namespace bw::cfd {
namespace {

template <class Eos>
class Scheme final : public CutScheme {
 public:
  Scheme(const Eos& eos, const typename Eos::Flow& flow, const BlockShape& shape)
      : eos_(eos), flow_(flow), kernel_(shape) {}

  void correct(const Patch& patch, const PatchCuts& cuts, double dt, BlockChange& change,
               WallExchange& exchange) override {
    kernel_.correct(patch, cuts, flow_, eos_, dt, change, exchange);
  }
  void begin(const Patch& patch, const PatchCuts& cuts, double dt) override {
    kernel_.begin(patch, cuts, flow_, eos_, dt);
  }
  WallLoad load(const Index3& cell, const Vec3& x, const Vec3& n, const Vec3& v) override {
    return kernel_.load(cell, x, n, v);
  }
  bool refill(const Patch& patch, const PatchCuts& cuts, const Index3& cell, double (&U)[Cons::count]) const override {
    typename WallGas<Eos>::State w;
    if (!cfd::refill(patch, cuts, flow_, eos_, cell, w)) return false;
    if constexpr (Eos::Flow::mixed) {
      double W[Prim::stored] = {};
      for (int q = 0; q < Prim::count; ++q) W[q] = w[size_t(q)];
      eos_.mix.to_conserved(W, U);
    } else {
      for (double& u : U) u = 0;
      const double rho = w[GasPrim::rho];
      const Vec3 v{w[GasPrim::v], w[GasPrim::v_y], w[GasPrim::v_z]};
      U[flow_.rho_row] = rho;
      for (int d = 0; d < 3; ++d) U[Cons::mom + d] = rho * v[d];
      U[Cons::rhoE] = flow_.over_G * w[GasPrim::p] + flow_.Pi + 0.5 * rho * dot(v, v);
      U[Cons::alpha1] = flow_.rho_row == Cons::arho1 ? 1 : 0;
    }
    return true;
  }

 private:
  Eos eos_;
  typename Eos::Flow flow_;
  CutKernel<Eos> kernel_;
};

}  // namespace

std::unique_ptr<CutScheme> make_cut_scheme(const Mixture& mixture, const BlockShape& shape) {
  return std::visit(
      [&](const auto& mix) -> std::unique_ptr<CutScheme> {
        using Eos = MixtureAtWall<std::decay_t<decltype(mix)>>;
        return std::make_unique<Scheme<Eos>>(Eos{mix}, MixedFlow{mix.closure()}, shape);
      },
      mixture);
}

std::unique_ptr<CutScheme> make_cut_scheme(const GasFlow& gas, const BlockShape& shape) {
  return std::make_unique<Scheme<GasAtWall>>(GasAtWall{gas.over_G, gas.Pi}, gas, shape);
}

}  // namespace bw::cfd
