// SPDX-License-Identifier: Apache-2.0
// The trilinear hexahedron and its 2x2x2 Gauss points, factorised: positions enter through seven modes (+-1 sums of the
// nodes), a Jacobian column at a point is a +- sum of four of them, and forces leave the same way, transposed. That
// takes about 150 operations where the dense form takes 576 multiply-adds.
//
// Points g = 0..7 stand at (xi, eta, zeta) = (+-1, +-1, +-1)/sqrt(3), xi changing fastest. Nodes: mesh.h.
#pragma once
#include <array>

#include "common/math/pack.h"
#include "common/math/tensor.h"

namespace bw::csd {

inline constexpr double gauss = 0.57735026918962576451;
/// Signs of (xi, eta, zeta) at the nodes.
inline constexpr int node_sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                        {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

/// A vector per node.
template <class T>
struct Corners {
  Vec<T> a[8];
};

/// Coefficients of xi, eta, zeta, xi eta, xi zeta, eta zeta, xi eta zeta in a nodal field, those of the products times
/// 1/sqrt(3), of the last times 1/3: as they appear at the points.
template <class T>
struct Modes {
  Vec<T> a[7];
};

/// x, y and z one after the other: eight values at a time stay in registers.
template <class T>
Modes<T> modes_of(const Corners<T>& corners) {
  const auto& x = corners.a;
  Modes<T> m;
  const auto component = [&](T Vec<T>::*c) {
    const T s0 = x[0].*c + x[1].*c, s1 = x[3].*c + x[2].*c, s2 = x[4].*c + x[5].*c, s3 = x[7].*c + x[6].*c;
    const T d0 = x[1].*c - x[0].*c, d1 = x[2].*c - x[3].*c, d2 = x[5].*c - x[4].*c, d3 = x[6].*c - x[7].*c;
    const T dp0 = d0 + d1, dp1 = d2 + d3, dm0 = d1 - d0, dm1 = d3 - d2;
    const T sp0 = s0 + s1, sp1 = s2 + s3, sm0 = s1 - s0, sm1 = s3 - s2;
    const T w1(0.125), w2(0.125 * gauss), w3(0.125 / 3.0);
    m.a[0].*c = w1 * (dp0 + dp1), m.a[1].*c = w1 * (sm0 + sm1), m.a[2].*c = w1 * (sp1 - sp0);
    m.a[3].*c = w2 * (dm0 + dm1), m.a[4].*c = w2 * (dp1 - dp0), m.a[5].*c = w2 * (sm1 - sm0);
    m.a[6].*c = w3 * (dm1 - dm0);
  };
  component(&Vec<T>::x), component(&Vec<T>::y), component(&Vec<T>::z);
  return m;
}

/// A vector per point and direction that depends on two of the three signs: [direction][first sign + 2 * second sign].
/// The column of direction xi depends on (eta, zeta), of eta on (xi, zeta), of zeta on (xi, eta). Not set at first.
template <class T>
struct Columns {
  T x[3][4], y[3][4], z[3][4];
  static constexpr int index(int direction, int g) {
    const int x = g & 1, e = (g >> 1) & 1, z = g >> 2;
    return direction == 0 ? e + 2 * z : direction == 1 ? x + 2 * z : x + 2 * e;
  }
  Vec<T> at(int direction, int g) const {
    const int i = index(direction, g);
    return {x[direction][i], y[direction][i], z[direction][i]};
  }
  void add(int direction, int g, const Vec<T>& a) {
    const int i = index(direction, g);
    x[direction][i] += a.x, y[direction][i] += a.y, z[direction][i] += a.z;
  }
  void clear() {
    for (auto* component : {&x, &y, &z})
      for (auto& row : *component)
        for (T& value : row) value = T(0);
  }
};

/// dx/dxi_k at the points.
template <class T>
Columns<T> columns_of(const Modes<T>& m) {
  const auto& a = m.a;
  Columns<T> r;
  const auto component = [&](T Vec<T>::*c, T(&to)[3][4]) {
    const auto direction = [&](T(&col)[4], T base, T first, T second, T both) {
      const T p = base + first, l = base - first, q = second + both, s = second - both;
      col[0] = l - s, col[1] = p - q, col[2] = l + s, col[3] = p + q;
    };
    direction(to[0], a[0].*c, a[3].*c, a[4].*c, a[6].*c);
    direction(to[1], a[1].*c, a[3].*c, a[5].*c, a[6].*c);
    direction(to[2], a[2].*c, a[4].*c, a[5].*c, a[6].*c);
  };
  component(&Vec<T>::x, r.x), component(&Vec<T>::y, r.y), component(&Vec<T>::z, r.z);
  return r;
}

/// Forces from the transposed map: f_a = - sum_g sum_k q_k(g) dN_a/dxi_k(g).
template <class T>
Corners<T> forces_from_columns(const Columns<T>& q) {
  Corners<T> f;
  const auto component = [&](T Vec<T>::*d, const T(&from)[3][4]) {
    struct Sums {
      T base, first, second, both;
    };
    const auto sums = [](const T(&c)[4]) -> Sums {
      const T u = c[0] + c[1], v = c[2] + c[3], s = c[1] - c[0], t = c[3] - c[2];
      return {u + v, s + t, v - u, t - s};
    };
    const Sums x = sums(from[0]), e = sums(from[1]), z = sums(from[2]);
    const T w1(-0.125), w2(-0.125 * gauss), w3(-0.125 / 3.0);
    const T F0 = w1 * x.base, F1 = w1 * e.base, F2 = w1 * z.base, F3 = w2 * (x.first + e.first),
            F4 = w2 * (x.second + z.first), F5 = w2 * (e.second + z.second), F6 = w3 * (x.both + e.both + z.both);
    // f_a = xi F0 + eta F1 + zeta F2 + xi eta F3 + xi zeta F4 + eta zeta F5 + xi eta zeta F6; l: zeta = -1, h: zeta = 1
    const T l0 = F0 - F4, l1 = F1 - F5, l3 = F3 - F6, h0 = F0 + F4, h1 = F1 + F5, h3 = F3 + F6;
    const T lm = l0 - l3, lp = l0 + l3, bm = F2 + l1, bp = F2 - l1;
    const T hm = h0 - h3, hp = h0 + h3, tm = F2 - h1, tp = F2 + h1;
    f.a[0].*d = -(bm + lm), f.a[1].*d = lm - bm, f.a[2].*d = lp - bp, f.a[3].*d = -(bp + lp);
    f.a[4].*d = tm - hm, f.a[5].*d = tm + hm, f.a[6].*d = tp + hp, f.a[7].*d = tp - hp;
  };
  component(&Vec<T>::x, q.x), component(&Vec<T>::y, q.y), component(&Vec<T>::z, q.z);
  return f;
}

/// Volume, exact (the terms of det that do not average out over the signs).
template <class T>
T volume_of(const Modes<T>& m) {
  const auto& a = m.a;
  return T(8) *
         (triple(a[0], a[1], a[2]) + triple(a[0], a[3], a[4]) + triple(a[3], a[1], a[5]) + triple(a[4], a[5], a[2]));
}

/// Integral of N_a over the element: 2x2x2 points are exact here too (det has degree 2 per direction, N_a 1).
inline std::array<double, 8> row_sums(const Corners<double>& X) {
  const Columns<double> g = columns_of(modes_of(X));
  std::array<double, 8> share{};
  for (int i = 0; i < 8; ++i) {
    const double det = triple(g.at(0, i), g.at(1, i), g.at(2, i));
    const double at[3] = {i & 1 ? gauss : -gauss, i & 2 ? gauss : -gauss, i & 4 ? gauss : -gauss};
    for (size_t a = 0; a < 8; ++a)
      share[a] +=
          0.125 * det * (1 + node_sign[a][0] * at[0]) * (1 + node_sign[a][1] * at[1]) * (1 + node_sign[a][2] * at[2]);
  }
  return share;
}

}  // namespace bw::csd
