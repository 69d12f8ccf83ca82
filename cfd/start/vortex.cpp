// SPDX-License-Identifier: Apache-2.0
#include "cfd/start/vortex.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "cfd/build.h"
#include "common/app/error.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

/// Gauss points of four: the mean over a cell is better than the scheme by far.
constexpr double node[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
constexpr double weight[4] = {0.17392742256872692, 0.32607257743127307, 0.32607257743127307, 0.17392742256872692};

struct Vortex {
  Vec3 centre;
  int axis;
  double radius, speed;

  /// W around it becomes W at x; false: no gas is left there.
  bool add(const GasFlow& gas, const Vec3& x, double (&W)[GasPrim::count]) const {
    Vec3 r = x - centre;
    r[axis] = 0;
    Vec3 along;
    along[axis] = 1;
    const double s2 = dot(r, r) / (radius * radius), core = speed * std::exp(0.5 * (1 - s2));
    const double gamma = 1 + 1 / gas.over_G, p_inf = gas.Pi / (gamma * gas.over_G);
    const double c2 = gamma * (W[GasPrim::p] + p_inf) / W[GasPrim::rho];
    const double share = 1 - 0.5 * (gamma - 1) * core * core / c2;  // of c^2; h - h_0 = (c^2 - c_0^2)/(gamma - 1)
    if (!(share > 0)) return false;
    W[GasPrim::rho] *= std::pow(share, 1 / (gamma - 1));
    W[GasPrim::p] = (W[GasPrim::p] + p_inf) * std::pow(share, gamma / (gamma - 1)) - p_inf;
    const Vec3 turn = cross(along, r);
    for (int d = 0; d < 3; ++d) W[GasPrim::v + d] += core / radius * turn[d];
    return W[GasPrim::p] > 0;
  }
};

}  // namespace

void paint_vortex(Model& m, const VortexCase& in) {
  const Vortex vortex{in.centre, in.axis[0] - 'x', in.radius, in.speed};
  const Medium& medium = m.setup.medium;
  std::atomic<bool> other{false}, empty{false};
  parallel_for_dynamic(m.forest.local_blocks(), [&](int64_t block) {
    const int b = int(block);
    const BlockShape& s = m.forest.shape(b);
    const Vec3 corner = m.forest.lower(b);
    for (int c = 0; c < s.cells(); ++c) {
      const int i = c % s.n[0], j = c / s.n[0] % s.n[1], k = c / (s.n[0] * s.n[1]);
      const size_t cell = s.at(k, j, i);
      double u[Cons::most];
      for (int q = 0; q < m.state.rows(); ++q) u[q] = m.state.block(b, q)[cell];
      const int material = medium.material_of(u) - 1;
      if (material < 0 || !medium.is_gas[material]) {
        other = true;
        continue;
      }
      const GasFlow& gas = medium.gas[material];
      double U[GasCons::count], W[GasPrim::stored], sum[GasCons::count] = {};
      for (int q = 0; q < GasCons::count; ++q) U[q] = m.state.block(b, gas.cons_row(q))[cell];
      gas_to_primitive(gas, U, W, medium.floors);
      for (int point = 0; point < 64; ++point) {
        const int g[3] = {point % 4, point / 4 % 4, point / 16};
        Vec3 x = corner + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z};
        double part = 1, w[GasPrim::count];
        for (int d = 0; d < 3; ++d) x[d] += 0.5 * s.h[d] * node[g[d]], part *= weight[g[d]];
        std::copy_n(W, int(GasPrim::count), w);
        if (!vortex.add(gas, x, w)) empty = true;
        const Vec3 v{w[GasPrim::v], w[GasPrim::v_y], w[GasPrim::v_z]};
        sum[GasCons::rho] += part * w[GasPrim::rho];
        for (int d = 0; d < 3; ++d) sum[GasCons::mom + d] += part * w[GasPrim::rho] * v[d];
        sum[GasCons::rhoE] += part * (gas.over_G * w[GasPrim::p] + gas.Pi + 0.5 * w[GasPrim::rho] * dot(v, v));
      }
      for (int q = 0; q < GasCons::count; ++q) m.state.block(b, gas.cons_row(q))[cell] = sum[q];
    }
  });
  if (m.forest.comm().sum(double(other)) > 0)
    throw InputError(fmt::format("{}: expected cells of one ideal or stiffened gas everywhere", in.place));
  if (m.forest.comm().sum(double(empty)) > 0)
    throw InputError(
        fmt::format("{}: expected a speed that leaves gas at the vortex's centre, not {:g} m/s", in.place, in.speed));
}

}  // namespace bw::cfd
