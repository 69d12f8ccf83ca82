// SPDX-License-Identifier: Apache-2.0
// Upper bounds of an element's largest eigenfrequency, K u = omega^2 M u, from its actual stiffness at the current
// geometry and stress; dt <= 2/omega_max. Never below the true value; within 2 % of it
// for a parallelepiped at rest.
//
// The tangent at a point, per current volume, for a displacement gradient H = du/dx with strain e = sym H:
//   (kappa' + sigma_m) (tr H)^2 + m |dev e|^2 + a |H|^2,  kappa' = J U'' (Volumetric::stiffness), m = 2 mu tr(b_bar)/3
//   / J,
// with a = |sigma_m| + 2 |s|/J at most from the stress terms -sigma_m tr(HH) and tr(H s H^T) - 4/3 tr(e) s:e. By Jensen
// the mean dilatation of Q1/P0 is no stiffer than the pointwise one. In parent coordinates H = G (dx/dxi)^-1, G =
// du/dxi. Largest value per |G|^2: with the eigenvalues c_i of C = (dx/dxi)^-T (dx/dxi)^-1, shears give at most (m + a)
// c_max and the normal strains the largest root of det(x - (m + a) diag(c) - l sqrt(c) sqrt(c)^T), l = kappa' + sigma_m
// - m/3: a cubic in the invariants of C. What remains is a Laplacian of the element's eight nodes with weights det_g
// x_g at the points.
#pragma once
#include <array>

#include "csd/element/hex.h"
#include "csd/element/q1p0.h"
#include "csd/material/concept.h"

namespace bw::csd {

/// Largest root x of that cubic (or an upper bound of it), for columns g_k = dx/dxi_k [m]: Pa/m^2. Newton from above
/// stays above, since all roots are real. lambda is taken as >= 0.
template <class T>
T point_stiffness(const Vec<T>& g1, const Vec<T>& g2, const Vec<T>& g3, T m, T lambda, int iterations) {
  const Vec<T> c1 = cross(g2, g3), c2 = cross(g3, g1), c3 = cross(g1, g2);
  const T det_g = dot(g1, c1), s = T(1) / (det_g * det_g);
  const T I1 = s * (dot(c1, c1) + dot(c2, c2) + dot(c3, c3)), I2 = s * (dot(g1, g1) + dot(g2, g2) + dot(g3, g3));
  const T l = max(lambda, T(0)), k2 = (m + l) * I1, k1 = m * (m + T(2) * l) * I2, k0 = m * m * (m + T(3) * l) * s;
  T x = k2;
  for (int i = 0; i < iterations; ++i) {
    const T value = x * (x * (x - k2) + k1) - k0, slope = x * (T(3) * x - T(2) * k2) + k1;
    x = x - max(value, T(0)) / slope;
  }
  return x;
}

/// omega^2 [1/s^2] of the parallelepiped with the element's centroid columns: the part of the bound that is followed in
/// every step. J_bar = v_e / V_e.
template <class T>
T centroid_omega2(const Vec<T> (&g)[3], T J_bar, T bulk, double mu, double density) {
  const T m = T(2 * mu) / J_bar;
  return point_stiffness(g[0], g[1], g[2], m, bulk - m * T(1.0 / 3.0), 2) * J_bar * T(1 / density);
}

/// Symmetric 8x8 matrix.
template <class T>
struct Sym8 {
  T a[8][8];
  T trace() const {
    T sum = a[0][0];
    for (int i = 1; i < 8; ++i) sum += a[i][i];
    return sum;
  }
  /// (s A)^2
  Sym8 scaled_square(T s) const {
    const T s2 = s * s;
    Sym8 r;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j <= i; ++j) {
        T sum = a[i][0] * a[j][0];
        for (int k = 1; k < 8; ++k) sum += a[i][k] * a[j][k];
        r.a[i][j] = r.a[j][i] = s2 * sum;
      }
    return r;
  }
  /// Frobenius' norm and the largest row sum, whichever is less: both bound the largest eigenvalue.
  T norm_bound() const {
    T squares(0), row_max(0);
    for (int i = 0; i < 8; ++i) {
      T row(0);
      for (int j = 0; j < 8; ++j) row += abs(a[i][j]), squares += a[i][j] * a[i][j];
      row_max = max(row_max, row);
    }
    return min(row_max, sqrt(squares));
  }
};

/// Upper bound of the largest eigenvalue of a positive semi-definite A, at most 2.6 % too high for a threefold one:
/// with A_0 = A, A_(n+1) = (A_n / tr A_n)^2, the spectral radius is tr A_0 sqrt(tr A_1 sqrt(tr A_2 ...)).
template <class T>
T largest_eigenvalue_bound(Sym8<T> A) {
  T traces[4];
  for (T& t : traces) {
    t = A.trace();
    A = A.scaled_square(T(1) / t);
  }
  T bound = A.norm_bound();
  for (int i = 3; i >= 0; --i) bound = traces[i] * sqrt(bound);
  return bound;
}

/// Products of shape function gradients at the points, sum_k dN_a/dxi_k dN_b/dxi_k.
inline constexpr std::array<Sym8<double>, 8> gradient_products = [] {
  std::array<Sym8<double>, 8> table{};
  for (int g = 0; g < 8; ++g) {
    const double at[3] = {g & 1 ? gauss : -gauss, g & 2 ? gauss : -gauss, g & 4 ? gauss : -gauss};
    double d[8][3]{};
    for (int a = 0; a < 8; ++a)
      for (int k = 0; k < 3; ++k) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        d[a][k] = 0.125 * node_sign[a][k] * (1 + node_sign[a][l] * at[l]) * (1 + node_sign[a][m] * at[m]);
      }
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) table[size_t(g)].a[a][b] = d[a][0] * d[b][0] + d[a][1] * d[b][1] + d[a][2] * d[b][2];
  }
  return table;
}();

/// What the energy of a collapsed point adds to its weight: its second variation per |G|^2, for r = det_g / (V0_g
/// J_bar). The part of J_bar in dr and the mixed terms are covered by a factor of 3 on the curvature (tested down to
/// inverted points).
template <class T>
T guard_weight(const Point<T>& p, const Vec<T>& g1, const Vec<T>& g2, const Vec<T>& g3, T J_bar, T kappa) {
  const T V0 = abs(p.det_g) / sqrt(p.trial.J_squared);
  const CollapseEnergy<T> e(p.det_g / (V0 * J_bar), kappa);
  const T cofactors = dot(p.c[0], p.c[0]) + dot(p.c[1], p.c[1]) + dot(p.c[2], p.c[2]);
  const T columns = dot(g1, g1) + dot(g2, g2) + dot(g3, g3);
  return T(3) * e.curvature / (V0 * J_bar * J_bar) * cofactors + abs(e.slope) / J_bar * sqrt(columns);
}
/// Sum over the points of |dE/dJ_bar| of that energy [J].
template <class T>
T guard_stress(const Columns<T>& g, const double* history, int components, T J_bar, T kappa) {
  T sum(0);
  for (int i = 0; i < 8; ++i) {
    const T det_g = triple(g.at(0, i), g.at(1, i), g.at(2, i));
    const T inverse_V0 = sqrt(max(det(load_sym<T>(history + i * components * lanes)), T(0)));
    sum += abs(CollapseEnergy<T>(det_g * inverse_V0 / J_bar, kappa).slope * det_g) / (J_bar * J_bar);
  }
  return sum;
}

/// Upper bound of omega^2 [1/s^2] of an element at positions x with the masses [kg] given at its nodes; sigma_m [Pa]:
/// the mean stress it bears. history as for internal_force, not changed.
template <class T, class M>
T omega2_bound(const M& material, const Corners<T>& x, T V0, const T (&mass)[8], T sigma_m, const double* history) {
  const Modes<T> modes = modes_of(x);
  const Columns<T> g = columns_of(modes);
  const T J_bar = volume_of(modes) / V0;
  const T kappa(material.volumetric.kappa), bulk = material.volumetric.stiffness(J_bar) + sigma_m;
  const T back = guard_stress(g, history, M::components, J_bar, kappa) / V0;  // what the guard adds to sigma_m
  Sym8<T> A{};
  for (int i = 0; i < 8; ++i) {
    const Vec<T>&g1 = g.at(0, i), &g2 = g.at(1, i), &g3 = g.at(2, i);
    const Point<T> p(g1, g2, g3, load_sym<T>(history + i * M::components * lanes));
    const T per_J = T(material.mu) * p.trial.iso * p.trial.iso * sqrt(p.trial.iso);  // mu J^(-2/3) / J
    const T m = T(2) * per_J * p.trial.third_trace;
    const T stress = abs(sigma_m) + T(2) * back + T(2) * per_J * sqrt(p.trial.dev2);
    // beyond inversion only the size of the volume counts; near zero volume the bound is large, as the stiffness is
    const T size = max(abs(p.det_g), T(1e-9) * V0);
    const T weight = size * point_stiffness(g1, g2, g3, m + stress, bulk - m * T(1.0 / 3.0), 4) +
                     guard_weight(p, g1, g2, g3, J_bar, kappa);
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b <= a; ++b) A.a[a][b] += T(gradient_products[size_t(i)].a[a][b]) * weight;
  }
  T root[8];
  for (int a = 0; a < 8; ++a) root[a] = T(1) / sqrt(mass[a]);
  for (int a = 0; a < 8; ++a)
    for (int b = 0; b <= a; ++b) A.a[a][b] = A.a[b][a] = root[a] * root[b] * A.a[a][b];
  return largest_eigenvalue_bound(A);
}

}  // namespace bw::csd
