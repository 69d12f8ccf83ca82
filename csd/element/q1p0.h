// SPDX-License-Identifier: Apache-2.0
// Q1/P0 mean-dilatation hexahedron: 2x2x2 points for the deviator, one mean stress from v_e / V_e (VALIDATION A.3).
//   f_a = - sum_g w_g s_g/J . grad N_a - sigma_m dv_e/dx_a        eq (15), internal part
// is minus the derivative of sum_e V_e U(v_e/V_e) + sum_g W_bar_g, so forces and moments sum to zero.
#pragma once
#include <bit>

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

/// Points of an element in the middle of a step.
template <class T>
struct Points {
  T det_g[8];            ///< current volume per parent volume
  Trial<T> trial[8];     ///< of those that flow
  unsigned flowing = 0;  ///< a bit per point with a lane that yields
};

/// The points that yield flow: new history, and q loses what their stresses lose. In two rounds, so that the long
/// dependent chains of one point's return overlap with those of the next. Out of line: an elastic element has none.
template <class T, class M>
[[gnu::noinline, gnu::flatten]] static void flow(const M& material, const Columns<T>& g, const Points<T>& p,
                                                 double* history, double per_dt, Columns<T>& q) {
  constexpr int stride = M::components * lanes;
  Response<T> response[8];
  for (unsigned left = p.flowing; left; left &= left - 1) {
    const int i = std::countr_zero(left);
    response[i] = material.respond(p.trial[i], history + i * stride, per_dt);
  }
  for (unsigned left = p.flowing; left; left &= left - 1) {
    const int i = std::countr_zero(left);
    double* at_point = history + i * stride;
    const Sym<T> A = load_sym<T>(at_point);
    const Trial<T>& t = p.trial[i];
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    const Vec<T> c1 = cross(g2, g3), c2 = cross(g3, g1), c3 = cross(g1, g2);
    const T k = (response[i].k - T(material.mu) * t.iso) * t.inverse_J;  // 0 in lanes that don't yield
    const T on_h = k * p.det_g[i], on_c = -k * t.third_trace;
    q.at(0, i) += on_h * (A.xx * g1 + A.xy * g2 + A.xz * g3) + on_c * c1;
    q.at(1, i) += on_h * (A.xy * g1 + A.yy * g2 + A.yz * g3) + on_c * c2;
    q.at(2, i) += on_h * (A.xz * g1 + A.yz * g2 + A.zz * g3) + on_c * c3;
    store_sym(at_point, response[i].keep * A + response[i].add * metric(c1, c2, c3, T(1) / (p.det_g[i] * p.det_g[i])));
  }
}

/// Forces of one element (or a pack of them) at positions x; commits the material's new history. V0 [m^3] reference
/// volume, mean_stress(J_bar) -> sigma_m [Pa]: U' of the material, or a filtered value, and what viscosity adds.
/// history: [8][M::components][lanes], at this element's lane. per_dt [1/s]: one over the time since the last call, for
/// flow that depends on the rate; 0: no time passes.
/// First as if no point flowed, then those that do are mended. The roots of J of all points come before anything else,
/// so that their long chains overlap.
template <class T, class M, class MeanStress>
ElementForce<T> internal_force(const M& material, const Corners<T>& x, T V0, double* history,
                               const MeanStress& mean_stress, double per_dt = 0) {
  const Modes<T> modes = modes_of(x);
  const Columns<T> g = columns_of(modes);
  const T volume = volume_of(modes), J_bar = volume / V0, sigma_m = mean_stress(J_bar);
  const T least_squared = T(collapse_ratio * collapse_ratio) * J_bar * J_bar;
  constexpr int stride = M::components * lanes;
  Points<T> p;
  T J_squared[8], root[8], collapsed(0);
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    p.det_g[i] = triple(g.at(0, i), g.at(1, i), g.at(2, i));
    J_squared[i] = squared_ratio(load_sym<T>(history + i * stride), p.det_g[i]);
    collapsed = select((J_squared[i] < least_squared) | (p.det_g[i] <= T(0)), T(1), collapsed);
  }
  inverse_sixth_roots(J_squared, root);
  Columns<T> q{};
#pragma GCC unroll 1
  for (int i = 0; i < 8; ++i) {
    const double* at_point = history + i * stride;
    for (int c = 0; c < M::components; ++c)
      __builtin_prefetch(at_point + (8 * M::components + c) * lanes);  // next block
    const Sym<T> A = load_sym<T>(at_point);
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    Vec<T> h1, h2, h3;
    const auto convect = [&](T Vec<T>::*c) {  // h_k = A^kl g_l
      h1.*c = A.xx * g1.*c + A.xy * g2.*c + A.xz * g3.*c;
      h2.*c = A.xy * g1.*c + A.yy * g2.*c + A.yz * g3.*c;
      h3.*c = A.xz * g1.*c + A.yz * g2.*c + A.zz * g3.*c;
    };
    const auto product = [&](T Vec<T>::*c, T Vec<T>::*d) { return h1.*c * g1.*d + h2.*c * g2.*d + h3.*c * g3.*d; };
    Sym<T> b;  // b^e
    convect(&Vec<T>::x);
    b.xx = product(&Vec<T>::x, &Vec<T>::x), b.xy = product(&Vec<T>::x, &Vec<T>::y),
    b.xz = product(&Vec<T>::x, &Vec<T>::z);
    convect(&Vec<T>::y);
    b.yy = product(&Vec<T>::y, &Vec<T>::y), b.yz = product(&Vec<T>::y, &Vec<T>::z);
    convect(&Vec<T>::z);
    b.zz = product(&Vec<T>::z, &Vec<T>::z);
    const T iso = root[i] * root[i], inverse_J = iso * root[i];
    const T third_trace = trace(b) * T(1.0 / 3.0);
    const Sym<T> dev{b.xx - third_trace, b.yy - third_trace, b.zz - third_trace, b.xy, b.xz, b.yz};
    // dev sigma = k dev b^e / J; times c_k: k/J (det_g h_k - t c_k), as b^e c_k = det_g h_k
    const T k = T(material.mu) * iso * inverse_J;  // eq (6)
    const T on_h = k * p.det_g[i], on_c = sigma_m - k * third_trace;
    q.at(0, i) += on_h * h1 + on_c * cross(g2, g3);
    q.at(1, i) += on_h * h2 + on_c * cross(g3, g1);
    q.at(2, i) += on_h * h3 + on_c * cross(g1, g2);
    const T dev2 = contract(dev, dev);
    if constexpr (M::plastic)
      if (any(material.yields(iso, dev2, at_point))) {
        p.flowing |= 1u << i;
        p.trial[i] = {J_squared[i], iso, inverse_J, third_trace, dev2, det(dev)};
      }
  }
  if constexpr (M::plastic)
    if (p.flowing) flow(material, g, p, history, per_dt, q);
  if (any(collapsed > T(0))) [[unlikely]] {
    T correction(0);
    collapse_guard(g, history, M::components, J_bar, volume, T(material.volumetric.kappa), q, correction);
    add_mean_stress(g, correction, q);
  }
  return {forces_from_columns(q), {modes.a[0], modes.a[1], modes.a[2]}, volume, collapsed};
}

}  // namespace bw::csd
