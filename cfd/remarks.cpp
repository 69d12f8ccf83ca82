// SPDX-License-Identifier: Apache-2.0
#include "cfd/remarks.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/error.h"
#include "common/app/log.h"

namespace bw::cfd {
namespace {

bool is_outside(const Case& cs, const Model& m, int body) {
  const coupling::WetSurface& s = m.walls->surface();
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (size_t f = 0; f < s.quads.size(); ++f)
    if (s.body[f] == body)
      for (const int32_t node : s.quads[f])
        for (int d = 0; d < 3; ++d)
          low[d] = std::min(low[d], s.x[size_t(node)][d]), high[d] = std::max(high[d], s.x[size_t(node)][d]);
  bool outside = false;
  for (int d = 0; d < 3; ++d)
    outside = outside || (m.forest.shape().used[size_t(d)] &&
                          (high[d] <= cs.fluid.grid.lower[d] || low[d] >= cs.fluid.grid.upper[d]));
  return outside;
}

}  // namespace

void remark(const Case& cs, const Model& m, const FluidSums& sums) {
  if (!(sums.volume > 0))
    throw InputError(fmt::format("{}: fluid: expected cells that hold fluid: bodies fill the whole domain", cs.file));
  for (int k = 0; k < m.setup.medium.count(); ++k) {
    const std::string& name = m.setup.medium.names[size_t(k)];
    const bool flows_in = std::any_of(cs.fluid.inflow.begin(), cs.fluid.inflow.end(),
                                      [&](const InflowCase& in) { return in.material == name; });
    if (!(sums.U[Cons::arho(k)] > 0) && !flows_in) warn("material \"{}\" fills no cell", name);
  }
  for (size_t b = 0; m.bodies && b < cs.fluid.body.size(); ++b)
    if (is_outside(cs, m, int(b))) warn("body \"{}\" is outside of the domain at the start", cs.fluid.body[b].name);
}

}  // namespace bw::cfd
