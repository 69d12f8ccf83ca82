// SPDX-License-Identifier: Apache-2.0
// Q1/P0 mean-dilatation hexahedron: 2x2x2 points for the deviator, one mean stress from v_e / V_e (VALIDATION A.3).
//   f_a = - sum_g w_g s_g/J . grad N_a - sigma_m dv_e/dx_a        eq (15), internal part
// is minus the derivative of sum_e V_e U(v_e/V_e) + sum_g W_bar_g, so forces and moments sum to zero.
#pragma once
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
    q.at(0, i) += sigma * c[0], q.at(1, i) += sigma * c[1], q.at(2, i) += sigma * c[2];
    back += sigma * det_g;  // dE/dJ_bar = -slope r / J_bar per point
  }
  sigma_m -= back / volume;
  return energy;
}

/// Adds sigma_m dv/dx, column by column: sum_g sigma_m c_k.
template <class T>
[[gnu::noinline]] void add_mean_stress(const Columns<T>& g, T sigma_m, Columns<T>& q) {
  for (int i = 0; i < 8; ++i) {
    q.at(0, i) += sigma_m * cross(g.at(1, i), g.at(2, i));
    q.at(1, i) += sigma_m * cross(g.at(2, i), g.at(0, i));
    q.at(2, i) += sigma_m * cross(g.at(0, i), g.at(1, i));
  }
}

/// Forces of one element (or a pack of them) at positions x; commits the material's new history. V0 [m^3] reference
/// volume, mean_stress(J_bar) -> sigma_m [Pa]: U' of the material, or a filtered value, and what viscosity adds.
/// history: [8][M::components][lanes], at this element's lane. per_dt [1/s]: one over the time since the last call, for
/// flow that depends on the rate; 0: no time passes.
/// In stages over the eight points, so that the long dependent chains of one point (cube root, return map) overlap with
/// those of the next.
template <class T, class M, class MeanStress>
ElementForce<T> internal_force(const M& material, const Corners<T>& x, T V0, double* history,
                               const MeanStress& mean_stress, double per_dt = 0) {
  const Modes<T> modes = modes_of(x);
  const Columns<T> g = columns_of(modes);
  const T volume = volume_of(modes), J_bar = volume / V0, sigma_m = mean_stress(J_bar);
  const T least_squared = T(collapse_ratio * collapse_ratio) * J_bar * J_bar;
  constexpr int stride = M::components * lanes;
  T det_g[8], collapsed(0);
  Trial<T> trial[8];
  Response<T> response[8];
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    det_g[i] = triple(g.at(0, i), g.at(1, i), g.at(2, i));
    trial[i].J_squared = squared_ratio(load_sym<T>(history + i * stride), det_g[i]);
    trial[i].iso = rcbrt(trial[i].J_squared);
    collapsed = select((trial[i].J_squared < least_squared) | (det_g[i] <= T(0)), T(1), collapsed);
  }
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    const Sym<T> A = load_sym<T>(history + i * stride);
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    const Sym<T> b = left_cauchy_green<T>(A.xx * g1 + A.xy * g2 + A.xz * g3, A.xy * g1 + A.yy * g2 + A.yz * g3,
                                          A.xz * g1 + A.yz * g2 + A.zz * g3, g1, g2, g3);
    const Sym<T> dev = deviator(b);
    trial[i].third_trace = trace(b) * T(1.0 / 3.0);
    trial[i].dev2 = contract(dev, dev);
    trial[i].dev_det = det(dev);
  }
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) response[i] = material.respond(trial[i], history + i * stride, per_dt);
  Columns<T> q{};
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    double* at_point = history + i * stride;
    const Sym<T> A = load_sym<T>(at_point);
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    const Vec<T> c1 = cross(g2, g3), c2 = cross(g3, g1), c3 = cross(g1, g2);
    // dev sigma = k dev b^e / J; times c_k: k/J (det_g h_k - t c_k), as b^e c_k = det_g h_k
    const T k = response[i].k * trial[i].iso * sqrt(trial[i].iso);
    const T on_h = k * det_g[i], on_c = sigma_m - k * trial[i].third_trace;
    q.at(0, i) += on_h * (A.xx * g1 + A.xy * g2 + A.xz * g3) + on_c * c1;
    q.at(1, i) += on_h * (A.xy * g1 + A.yy * g2 + A.yz * g3) + on_c * c2;
    q.at(2, i) += on_h * (A.xz * g1 + A.yz * g2 + A.zz * g3) + on_c * c3;
    if (response[i].flows)
      store_sym(at_point, response[i].keep * A + response[i].add * metric(c1, c2, c3, T(1) / (det_g[i] * det_g[i])));
  }
  if (any(collapsed > T(0))) [[unlikely]] {
    T correction(0);
    collapse_guard(g, history, M::components, J_bar, volume, T(material.volumetric.kappa), q, correction);
    add_mean_stress(g, correction, q);
  }
  return {forces_from_columns(q), {modes.a[0], modes.a[1], modes.a[2]}, volume, collapsed};
}

}  // namespace bw::csd
