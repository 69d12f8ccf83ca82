// SPDX-License-Identifier: Apache-2.0
// The gas behind a wall as the mirror image of the gas before it.
#pragma once
#include <algorithm>

#include "cfd/embed/cut_map.h"

namespace bw::cfd {

/// The image of `point` in the wall through `on_wall` with unit normal n.
inline Vec3 image_of(const Vec3& point, const Vec3& on_wall, const Vec3& n) {
  return point - 2 * dot(point - on_wall, n) * n;
}

/// What stands behind the wall w where before it the gas is `at`, `height` [m] above it: the normal velocity turned
/// about the wall's, the pressure on along dp/dn = -rho a_n to the other side, the density along the isentrope. The
/// pressure changes by no more than a factor of two: a wall that starts at once has no bound of its acceleration. early
/// [s]: how long before the time that w.v belongs to.
template <class Gas>
typename Gas::State mirrored(const Gas& gas, const typename Gas::State& at, const WallSide& w, double height,
                             double early = 0) {
  typename Gas::State out = at;
  const Vec3 back = -2 * (dot(Gas::velocity(at) - w.v, w.n) + early * w.a_n) * w.n;
  for (int e = 0; e < 3; ++e) out[size_t(Gas::v + e)] += back[e];
  if (w.a_n == 0) return out;
  const double rise = 2 * height * Gas::rho(at) * w.a_n;
  out[Gas::p] = at[Gas::p] + std::clamp(rise, -0.5 * at[Gas::p], at[Gas::p]);
  gas.put_on_isentrope(at, 1, out);
  return out;
}

}  // namespace bw::cfd
