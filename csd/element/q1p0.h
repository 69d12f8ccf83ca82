// SPDX-License-Identifier: Apache-2.0
// Q1/P0 mean-dilatation hexahedron: 2x2x2 points for the deviator, one mean stress from v_e / V_e (VALIDATION A.3).
//   f_a = - sum_g w_g s_g/J . grad N_a - sigma_m dv_e/dx_a        eq (15), internal part
// is minus the derivative of sum_e V_e U(v_e/V_e) + sum_g W_bar_g, so forces and moments sum to zero.
#pragma once
#include <bit>

#include "common/math/two.h"
#include "csd/element/hex.h"
#include "csd/material/concept.h"

namespace bw::csd {

/// J_g / J_bar below which a point is called collapsed: Q1/P0 has no pointwise volume stiffness.
inline constexpr double collapse_ratio = 0.3;

template <class T>
struct ElementForce {
  Corners<T> f;      ///< N, on the nodes: -dE/dx
  Vec<T> centre[3];  ///< m, dx/dxi_k at the centroid
  T volume;          ///< m^3, current
  T collapsed;       ///< > 0: a point has J_g < collapse_ratio J_bar (or is inverted)
  bool flowed;       ///< the history has changed
};

/// Which work an element may pass over; the results are the same.
struct Skips {
  bool elastic = true;   ///< the return mapping, where no point yields
  bool uniform = false;  ///< all points remember what the first does (PointHistory): it alone is read
};

/// Collapsed points push back (DESIGN 5b): energy kappa/2 ln^2(r / collapse_ratio) per reference volume for r =
/// J_g/J_bar below the ratio, continued quadratically in r below a sixth of it so that even an inverted point has a way
/// back.
template <class T>
struct CollapseEnergy {
  T value, slope, curvature;  ///< J/m^3, by r
  CollapseEnergy(T r, T kappa) {
    const auto active = r < T(collapse_ratio);
    const T r_log = max(r, T(collapse_ratio / 6)), l = log(r_log * T(1 / collapse_ratio)),
            d = r - r_log;  // d = 0 above
    const T s = kappa * l / r_log, c = kappa * (T(1) - l) / (r_log * r_log);
    value = select(active, T(0.5) * kappa * l * l + s * d + T(0.5) * c * d * d, T(0));
    slope = select(active, s + c * d, T(0));
    curvature = select(active, c, T(0));
  }
};

/// Adds to q the columns sum_g sigma_g c_k of that energy, and to sigma_m what J_bar contributes; returns the energy
/// [J]. Rare, so it recomputes.
template <class T>
[[gnu::noinline]] T collapse_guard(const Columns<T>& g, const double* history, int components, T J_bar, T volume,
                                   T kappa, Columns<T>& q, T& sigma_m) {
  T energy(0), back(0);
  for (int i = 0; i < 8; ++i) {
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    const Vec<T> c[3] = {cross(g2, g3), cross(g3, g1), cross(g1, g2)};
    const T inverse_V0 = sqrt(max(det(load_sym<T>(history + i * components * lanes)), T(0)));
    const T det_g = dot(g1, c[0]);
    const CollapseEnergy<T> e(det_g * inverse_V0 / J_bar, kappa);
    energy += e.value / inverse_V0;
    const T sigma = e.slope / J_bar;  // dE/d(det_g) = slope inverse_V0 / J_bar / inverse_V0
    q.add(0, i, sigma * c[0]), q.add(1, i, sigma * c[1]), q.add(2, i, sigma * c[2]);
    back += sigma * det_g;  // dE/dJ_bar = -slope r / J_bar per point
  }
  sigma_m -= back / volume;
  return energy;
}

/// Adds sigma_m dv/dx, column by column: sum_g sigma_m c_k.
template <class T>
[[gnu::noinline]] void add_mean_stress(const Columns<T>& g, T sigma_m, Columns<T>& q) {
  for (int i = 0; i < 8; ++i) {
    q.add(0, i, sigma_m * cross(g.at(1, i), g.at(2, i)));
    q.add(1, i, sigma_m * cross(g.at(2, i), g.at(0, i)));
    q.add(2, i, sigma_m * cross(g.at(0, i), g.at(1, i)));
  }
}

/// Points of an element in the middle of a step. Not set at first.
template <class T>
struct Points {
  T h[8][3][3];               ///< [point][k][x y z], h_k = A^kl g_l
  T det_g[8];                 ///< current volume per parent volume
  T J_squared[8];             ///< det b^e
  T root[8];                  ///< J^(-1/3)
  T third_trace[8], dev2[8];  ///< tr b^e / 3, |dev b^e|^2
  T k[8];                     ///< Pa, dev tau = k dev b^e
};

/// First pass over a point: b^e and its invariants.
template <class T>
void convect(const Sym<T>& A, const Vec<T>& g1, const Vec<T>& g2, const Vec<T>& g3, int i, Points<T>& p) {
  const T det_g = p.det_g[i] = triple(g1, g2, g3);
  p.J_squared[i] = squared_ratio(A, det_g);
  auto& h = p.h[i];
  const auto component = [&](T Vec<T>::*c, int d) {
    h[0][d] = A.xx * g1.*c + A.xy * g2.*c + A.xz * g3.*c;
    h[1][d] = A.xy * g1.*c + A.yy * g2.*c + A.yz * g3.*c;
    h[2][d] = A.xz * g1.*c + A.yz * g2.*c + A.zz * g3.*c;
  };
  const auto product = [&](int d, T Vec<T>::*c) { return h[0][d] * g1.*c + h[1][d] * g2.*c + h[2][d] * g3.*c; };
  Sym<T> b;  // b^e
  component(&Vec<T>::x, 0);
  b.xx = product(0, &Vec<T>::x), b.xy = product(0, &Vec<T>::y), b.xz = product(0, &Vec<T>::z);
  component(&Vec<T>::y, 1);
  b.yy = product(1, &Vec<T>::y), b.yz = product(1, &Vec<T>::z);
  component(&Vec<T>::z, 2);
  b.zz = product(2, &Vec<T>::z);
  const T t = p.third_trace[i] = trace(b) * T(1.0 / 3.0);
  const Sym<T> dev{b.xx - t, b.yy - t, b.zz - t, b.xy, b.xz, b.yz};
  p.dev2[i] = contract(dev, dev);
}

/// The points that yield flow: new history, and their k. In two rounds, so that the long dependent chains of one
/// point's return overlap with those of the next. Out of line: an elastic element has none.
template <class T, class M>
[[gnu::noinline, gnu::flatten]] static void flow(const M& material, const Columns<T>& g, unsigned flowing,
                                                 double* history, double per_dt, Points<T>& p) {
  constexpr int stride = M::components * lanes;
  constexpr int together = M::points_together;
  using Side = SideBySide<T, stride, together>;
  using S = typename Side::Type;
  T keep[8], add[8];
  for (int i = 0; i < 8; i += together) {
    if (!(flowing >> i & ((1u << together) - 1))) continue;
    const S J_squared = Side::join(p.J_squared + i), root = Side::join(p.root + i), iso = root * root;
    const S t = Side::join(p.third_trace + i), dev2 = Side::join(p.dev2 + i);
    // det dev b^e from det b^e and the other invariants
    const Trial<S> trial{J_squared, iso, t, dev2, J_squared - t * (t * t - S(0.5) * dev2)};
    const Response<S> r = material.respond(trial, history + i * stride, per_dt);
    Side::part(r.k, p.k + i), Side::part(r.keep, keep + i), Side::part(r.add, add + i);
  }
  for (unsigned left = flowing; left; left &= left - 1) {
    const int i = std::countr_zero(left);
    if (!any(keep[i] < T(1))) continue;
    double* at_point = history + i * stride;
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    const T inverse_det2 = T(1) / (p.det_g[i] * p.det_g[i]);
    store_sym(at_point, keep[i] * load_sym<T>(at_point) +
                            add[i] * metric(cross(g2, g3), cross(g3, g1), cross(g1, g2), inverse_det2));
  }
}

/// Forces of one element (or a pack of them) at positions x; commits the material's new history. V0 [m^3] reference
/// volume, mean_stress(J_bar) -> sigma_m [Pa]: U' of the material, or a filtered value, and what viscosity adds.
/// history: [8][M::components][lanes], at this element's lane. per_dt [1/s]: one over the time since the last call, for
/// flow that depends on the rate; 0: no time passes.
/// In passes over the points, each with short dependent chains, so that a processor overlaps one point with the next:
/// strains, roots of J, flow of the points that yield, forces.
template <class T, class M, class MeanStress>
ElementForce<T> internal_force(const M& material, const Corners<T>& x, T V0, double* history,
                               const MeanStress& mean_stress, double per_dt = 0, Skips skip = {}) {
  const Modes<T> modes = modes_of(x);
  const Columns<T> g = columns_of(modes);
  const int stride = skip.uniform ? 0 : M::components * lanes;
  Points<T> p;
  T least_det(1e300), least_squared(1e300);
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    const double* at_point = history + i * stride;
    if (!skip.uniform || i == 0)
      for (int c = 0; c < M::components; ++c)
        __builtin_prefetch(at_point + (8 * M::components + c) * lanes);  // next block
    convect(load_sym<T>(at_point), g.at(0, i), g.at(1, i), g.at(2, i), i, p);
    least_det = min(least_det, p.det_g[i]), least_squared = min(least_squared, p.J_squared[i]);
  }
  const T volume = volume_of(modes), J_bar = volume / V0, sigma_m = mean_stress(J_bar);
  const auto is_collapsed = (least_squared < T(collapse_ratio * collapse_ratio) * J_bar * J_bar) | (least_det <= T(0));
  inverse_sixth_roots(p.J_squared, p.root);
  for (int i = 0; i < 8; ++i) p.k[i] = T(material.mu) * (p.root[i] * p.root[i]);  // eq (6)
  unsigned flowing = 0;  // a bit per point with a lane that yields
  if constexpr (M::plastic) {
    for (int i = 0; i < 8; ++i)
      flowing |= unsigned(any(material.yields(p.root[i] * p.root[i], p.dev2[i], history + i * stride))) << i;
    if (!skip.elastic) flowing = 255;
    if (flowing) flow(material, g, flowing, history, per_dt, p);
  }
  Columns<T> q;
  q.clear();
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    // dev sigma = k dev b^e / J; times c_k: k/J (det_g h_k - t c_k), as b^e c_k = det_g h_k
    const T k = p.k[i] * (p.root[i] * p.root[i]) * p.root[i];
    const T on_h = k * p.det_g[i], on_c = sigma_m - k * p.third_trace[i];
    const auto part = [&](int d, const Vec<T>& c) {
      const auto& h = p.h[i][d];
      q.add(d, i, {on_h * h[0] + on_c * c.x, on_h * h[1] + on_c * c.y, on_h * h[2] + on_c * c.z});
    };
    part(0, cross(g2, g3)), part(1, cross(g3, g1)), part(2, cross(g1, g2));
  }
  if (any(is_collapsed)) [[unlikely]] {
    T correction(0);
    collapse_guard(g, history, M::components, J_bar, volume, T(material.volumetric.kappa), q, correction);
    add_mean_stress(g, correction, q);
  }
  return {forces_from_columns(q),
          {modes.a[0], modes.a[1], modes.a[2]},
          volume,
          select(is_collapsed, T(1), T(0)),
          flowing != 0};
}

}  // namespace bw::csd
