// SPDX-License-Identifier: Apache-2.0
// An integration point as a material sees it, in parent coordinates xi_k of its element: nothing of the reference
// configuration is needed but the metric that the history holds.
//
// History (SOLID): the contravariant convected components A^kl of the elastic left Cauchy-Green tensor,
//   b^e = A^kl g_k (x) g_l,   g_k = dx/dxi_k,   det A = det C_p^-1 / det(dX/dxi)^2.
// They start as the inverse reference metric and change only by plastic flow: an elastic step reads them and needs no
// F, no inverse and no reference gradients. Plastic flow is isochoric, so det A keeps the reference volume.
#pragma once
#include "common/math/pack.h"
#include "common/math/tensor.h"

namespace bw::csd {

/// T = double or Pack; rows of the history are `lanes` apart.
template <class T>
T load(const double* p) {
  if constexpr (sizeof(T) == sizeof(double))
    return *p;
  else
    return T::load(p);
}
inline void store(double* p, double a) { *p = a; }
inline void store(double* p, Pack a) { a.store(p); }

template <class T>
Sym<T> load_sym(const double* p) {
  return {load<T>(p),         load<T>(p + lanes),     load<T>(p + 2 * lanes), load<T>(p + 3 * lanes),
          load<T>(p + 4 * lanes), load<T>(p + 5 * lanes)};
}
template <class T>
void store_sym(double* p, const Sym<T>& a) {
  store(p, a.xx), store(p + lanes, a.yy), store(p + 2 * lanes, a.zz);
  store(p + 3 * lanes, a.xy), store(p + 4 * lanes, a.xz), store(p + 5 * lanes, a.yz);
}

template <class T>
struct Point {
  Vec<T> c[3];    ///< g_2 x g_3, ...: grad xi_k = c_k / det_g
  Vec<T> h[3];    ///< h_k = A^kl g_l
  Sym<T> A;       ///< history
  T det_g;        ///< current volume per parent volume
  T J_squared;    ///< J^2 = det A det_g^2, the pointwise volume ratio squared
  T iso;          ///< J^(-2/3): b_bar = iso b^e
  T third_trace;  ///< tr b^e / 3 (not isochoric)
  Sym<T> dev_b;   ///< dev b^e (not isochoric)

  Point(const Vec<T>& g1, const Vec<T>& g2, const Vec<T>& g3, const Sym<T>& A_history)
      : c{cross(g2, g3), cross(g3, g1), cross(g1, g2)}, A(A_history) {
    det_g = dot(g1, c[0]);
    h[0] = A.xx * g1 + A.xy * g2 + A.xz * g3;
    h[1] = A.xy * g1 + A.yy * g2 + A.yz * g3;
    h[2] = A.xz * g1 + A.yz * g2 + A.zz * g3;
    // a point on its way to inversion must stay finite: below J = 1e-6 the guard of the element has long taken over
    J_squared = max(det(A) * (det_g * det_g), T(1e-12));
    iso = rcbrt(J_squared);
    const Sym<T> b{h[0].x * g1.x + h[1].x * g2.x + h[2].x * g3.x, h[0].y * g1.y + h[1].y * g2.y + h[2].y * g3.y,
                   h[0].z * g1.z + h[1].z * g2.z + h[2].z * g3.z, h[0].x * g1.y + h[1].x * g2.y + h[2].x * g3.y,
                   h[0].x * g1.z + h[1].x * g2.z + h[2].x * g3.z, h[0].y * g1.z + h[1].y * g2.z + h[2].y * g3.z};
    third_trace = trace(b) * T(1.0 / 3.0);
    dev_b = {b.xx - third_trace, b.yy - third_trace, b.zz - third_trace, b.xy, b.xz, b.yz};
  }
  /// Contravariant components of the spatial metric, G^kl = grad xi_k . grad xi_l.
  Sym<T> metric() const {
    const T s = T(1) / (det_g * det_g);
    return {s * dot(c[0], c[0]), s * dot(c[1], c[1]), s * dot(c[2], c[2]),
            s * dot(c[0], c[1]), s * dot(c[0], c[2]), s * dot(c[1], c[2])};
  }
};

}  // namespace bw::csd
