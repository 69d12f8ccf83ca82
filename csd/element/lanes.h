// SPDX-License-Identifier: Apache-2.0
// Between nodal fields and packs of elements.
#pragma once
#include "common/math/pack.h"
#include "csd/element/hex.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Nodal values (of a Field: a little is read beyond its end) of the Pack::size elements that start at `nodes`, rows of
/// which are `lanes` apart.
inline Corners<Pack> gather(const Vec3* x, const int32_t* nodes) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const auto corner = [&](int a) {
    Vec<Pack> r;
    load_points(&x->x, nodes + a * lanes, r.x, r.y, r.z);
    return r;
  };
  return {{corner(0), corner(1), corner(2), corner(3), corner(4), corner(5), corner(6), corner(7)}};
}
inline Corners<double> corners(const Mesh& mesh, ElemId e) {
  const auto& h = mesh.hex[e];
  const auto& X = mesh.X;
  return {{X[h[0]], X[h[1]], X[h[2]], X[h[3]], X[h[4]], X[h[5]], X[h[6]], X[h[7]]}};
}

/// Adds to nodes of the first `count` lanes.
inline void scatter_add(const Corners<Pack>& f, const int32_t* nodes, int count, PaddedPoint* out) {
  for (int a = 0; a < 8; ++a) add_points(out, nodes + a * lanes, count, f.a[a].x, f.a[a].y, f.a[a].z);
}

/// Likewise, but corners with a place (>= 0, laid out as nodes) go there.
inline void scatter_border(const Corners<Pack>& f, const int32_t* nodes, const int32_t* places, int count,
                           PaddedPoint* out, Vec3* border) {
  for (int a = 0; a < 8; ++a)
    for (int l = 0; l < count; ++l) {
      const int i = a * lanes + l;
      const Vec3 value{f.a[a].x[l], f.a[a].y[l], f.a[a].z[l]};
      if (places[i] >= 0)
        border[places[i]] = value;
      else
        out[nodes[i]].x += value.x, out[nodes[i]].y += value.y, out[nodes[i]].z += value.z;
    }
}

}  // namespace bw::csd
