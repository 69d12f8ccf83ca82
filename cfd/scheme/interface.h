// SPDX-License-Identifier: Apache-2.0
// Sharp interfaces of two materials: THINC [Xiao, Ii, Chen 2011; Shyue, Xiao 2014]. In a cell that holds both, alpha1
// is not a limited line but  (1 + s tanh(b (x - x0)))/2  over the cell (x from 0 to 1), with x0 such that its mean is
// the cell's. What leaves through a face is the mean of that curve over the part of the cell that passes in the step,
// so that no cell gives more than it has. Densities and Pi follow alpha at the cell's own rho_1, rho_2 and Pi_k:
// pressure and velocity stay constant across a contact.
#pragma once
#include "cfd/mix/variables.h"
#include "common/math/pack.h"

namespace bw::cfd {

struct Interface {
  double sharpness = 0;    ///< b across the interface; 0: lines, as everything else
  double Pi_gas[2] = {};   ///< of materials 1, 2 where it does not depend on density
  bool is_gas[2] = {};     ///< one of them must be
  double heaviest = 1e30;  ///< density of a face over its cell's that its waves may be made of (hllc.h)

  static constexpr double least = 1e-4;  ///< share of a material below which a cell counts as one of the other alone
};

/// What its faces need of a cell.
template <class T>
struct SharpCell {
  T alpha1, rho1, rho2, Pi1, Pi2;  ///< densities and Pi_k of the materials themselves, half a step later

  /// W: the cell's Prim rows; div: dt/2 div v; dPi: its row.
  SharpCell(const Interface& f, const T (&W)[Prim::count], T div, T dPi) : alpha1(W[Prim::alpha1]) {
    const T tiny(1e-100), alpha2 = T(1) - alpha1, keep = T(1) - div;
    rho1 = W[Prim::arho1] / max(alpha1, tiny) * keep;
    rho2 = W[Prim::arho2] / max(alpha2, tiny) * keep;
    const T Pi = W[Prim::Pi] - dPi * div;
    if (f.is_gas[1]) {
      Pi2 = T(f.Pi_gas[1]);
      Pi1 = (Pi - alpha2 * Pi2) / max(alpha1, tiny);
    } else {
      Pi1 = T(f.Pi_gas[0]);
      Pi2 = (Pi - alpha1 * Pi1) / max(alpha2, tiny);
    }
  }
  /// Rows of W that follow alpha.
  template <class M>
  void put(T alpha, M where, T (&W)[Prim::count]) const {
    const T other = T(1) - alpha;
    W[Prim::alpha1] = select(where, alpha, W[Prim::alpha1]);
    W[Prim::arho1] = select(where, alpha * rho1, W[Prim::arho1]);
    W[Prim::arho2] = select(where, other * rho2, W[Prim::arho2]);
    W[Prim::Pi] = select(where, alpha * Pi1 + other * Pi2, W[Prim::Pi]);
  }
};

/// Is it a cell of both materials, between a lower and a higher alpha?
template <class T>
auto holds_interface(T low, T alpha, T high) {
  return (min(alpha, T(1) - alpha) > T(Interface::least)) & ((high - alpha) * (alpha - low) > T(0));
}

/// Means of the curve over the parts `low` and `high` of the cell at its lower and upper face; b > 0.
template <class T>
struct SharpCurve {
  T at_low, at_high;
  SharpCurve(T alpha, T rising, T b, T low, T high) {
    const T e = exp(b), tanh_b = (e - T(1) / e) / (e + T(1) / e), cosh_b = T(0.5) * (e + T(1) / e);
    const T A = (exp(rising * b * (alpha + alpha - T(1))) / cosh_b - T(1)) / tanh_b;  // tanh(-b x0)
    const T x = exp(b * low), y = exp(b * (T(1) - high));
    const auto curve = [&](T u) { return T(0.5) * ((u + T(1) / u) + A * (u - T(1) / u)); };
    at_low = T(0.5) * (T(1) + rising * log(curve(x)) / (b * low));
    at_high = T(0.5) * (T(1) + rising * log(curve(e) / curve(y)) / (b * high));
    at_low = min(max(at_low, T(0)), T(1)), at_high = min(max(at_high, T(0)), T(1));
  }
};

/// Sets the states of a cell's faces normal to one direction where it holds an interface. v_low, v_high: dt/h times the
/// velocity at its faces; b: sharpness in this direction.
template <class T>
void sharpen(const SharpCell<T>& cell, T alpha_low, T alpha_high, T b, T v_low, T v_high, auto where,
             T (&low)[Prim::count], T (&high)[Prim::count]) {
  const auto inside = where & holds_interface(alpha_low, cell.alpha1, alpha_high);
  if (!any(inside)) return;
  const auto part = [](T swept) { return min(max(swept, T(1e-3)), T(1)); };
  const SharpCurve<T> curve(cell.alpha1, select(alpha_high > alpha_low, T(1), T(-1)), b, part(-v_low), part(v_high));
  cell.put(curve.at_low, inside, low);
  cell.put(curve.at_high, inside, high);
}

}  // namespace bw::cfd
