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

// T = double, Pack or Two; rows of the history are `lanes` apart.
template <class T>
Sym<T> load_sym(const double* p) {
  return {load<T>(p),
          load<T>(p + lanes),
          load<T>(p + 2 * lanes),
          load<T>(p + 3 * lanes),
          load<T>(p + 4 * lanes),
          load<T>(p + 5 * lanes)};
}
template <class T>
void store_sym(double* p, const Sym<T>& a) {
  store(p, a.xx), store(p + lanes, a.yy), store(p + 2 * lanes, a.zz);
  store(p + 3 * lanes, a.xy), store(p + 4 * lanes, a.xz), store(p + 5 * lanes, a.yz);
}

/// b^e from h_k = A^kl g_l.
template <class T>
Sym<T> left_cauchy_green(const Vec<T>& h1, const Vec<T>& h2, const Vec<T>& h3, const Vec<T>& g1, const Vec<T>& g2,
                         const Vec<T>& g3) {
  return {h1.x * g1.x + h2.x * g2.x + h3.x * g3.x, h1.y * g1.y + h2.y * g2.y + h3.y * g3.y,
          h1.z * g1.z + h2.z * g2.z + h3.z * g3.z, h1.x * g1.y + h2.x * g2.y + h3.x * g3.y,
          h1.x * g1.z + h2.x * g2.z + h3.x * g3.z, h1.y * g1.z + h2.y * g2.z + h3.y * g3.z};
}

/// det b^e = J^2 from the history and the Jacobian. A point on its way to inversion must stay finite: below J = 1e-6
/// the guard of the element has long taken over.
template <class T>
T squared_ratio(const Sym<T>& A, T det_g) {
  return max(det(A) * (det_g * det_g), T(1e-12));
}

/// Contravariant components of the spatial metric, G^kl = grad xi_k . grad xi_l, from cofactor columns c_k.
template <class T>
Sym<T> metric(const Vec<T>& c1, const Vec<T>& c2, const Vec<T>& c3, T inverse_det2) {
  const T& s = inverse_det2;
  return {s * dot(c1, c1), s * dot(c2, c2), s * dot(c3, c3), s * dot(c1, c2), s * dot(c1, c3), s * dot(c2, c3)};
}

/// All that an isotropic material needs: the invariants of b^e (not isochoric), and J.
template <class T>
struct Trial {
  T J_squared;    ///< det b^e
  T iso;          ///< J^(-2/3): b_bar = iso b^e
  T third_trace;  ///< tr b^e / 3
  T dev2;         ///< |dev b^e|^2
  T dev_det;      ///< det dev b^e
};

/// What it answers.
template <class T>
struct Response {
  T k;          ///< Pa, dev tau = k dev b^e at the end of the step (b^e before it)
  T keep, add;  ///< history after the step: A <- keep A + add G
};

/// One point with everything about it; the force kernel does the same in stages.
template <class T>
struct Point {
  Vec<T> c[3];  ///< g_2 x g_3, ...: grad xi_k = c_k / det_g
  Vec<T> h[3];  ///< h_k = A^kl g_l
  T det_g;      ///< current volume per parent volume
  Sym<T> dev_b;
  Trial<T> trial;

  Point(const Vec<T>& g1, const Vec<T>& g2, const Vec<T>& g3, const Sym<T>& A)
      : c{cross(g2, g3), cross(g3, g1), cross(g1, g2)},
        h{A.xx * g1 + A.xy * g2 + A.xz * g3, A.xy * g1 + A.yy * g2 + A.yz * g3, A.xz * g1 + A.yz * g2 + A.zz * g3},
        det_g(dot(g1, c[0])) {
    const Sym<T> b = left_cauchy_green(h[0], h[1], h[2], g1, g2, g3);
    trial.third_trace = trace(b) * T(1.0 / 3.0);
    dev_b = {b.xx - trial.third_trace, b.yy - trial.third_trace, b.zz - trial.third_trace, b.xy, b.xz, b.yz};
    trial.J_squared = squared_ratio(A, det_g);
    const T root = inverse_sixth_root(trial.J_squared);
    trial.iso = root * root;
    trial.dev2 = contract(dev_b, dev_b);
    trial.dev_det = det(dev_b);
  }
};

}  // namespace bw::csd
