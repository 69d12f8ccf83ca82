// SPDX-License-Identifier: Apache-2.0
// Two points side by side: a number type for kernels whose dependent chains are long (logarithms, roots, Newton's
// steps), so that a processor works on one while it waits for the other. Reads like a Pack; the same operations on each.
#pragma once
#include "common/math/pack.h"

namespace bw {

template <class M>
struct TwoMasks {
  M a, b;
  friend TwoMasks operator&(TwoMasks m, TwoMasks n) { return {M(m.a & n.a), M(m.b & n.b)}; }
  friend TwoMasks operator|(TwoMasks m, TwoMasks n) { return {M(m.a | n.a), M(m.b | n.b)}; }
  friend TwoMasks operator!(TwoMasks m) { return {!m.a, !m.b}; }
  friend bool any(TwoMasks m) { return any(m.a | m.b); }
};

/// T = double, Pack, or Two of them. The second is stored `stride` doubles behind the first.
template <class T, int stride>
struct Two {
  T a, b;
  Two() = default;
  Two(double x) : a(x), b(x) {}
  Two(T a, T b) : a(a), b(b) {}
  static Two load(const double* p) { return {bw::load<T>(p), bw::load<T>(p + stride)}; }
  void store(double* p) const { bw::store(p, a), bw::store(p + stride, b); }
  friend Two operator+(Two x, Two y) { return {x.a + y.a, x.b + y.b}; }
  friend Two operator-(Two x, Two y) { return {x.a - y.a, x.b - y.b}; }
  friend Two operator*(Two x, Two y) { return {x.a * y.a, x.b * y.b}; }
  friend Two operator/(Two x, Two y) { return {x.a / y.a, x.b / y.b}; }
  friend Two operator-(Two x) { return {-x.a, -x.b}; }
  Two& operator+=(Two y) { return *this = *this + y; }
  Two& operator-=(Two y) { return *this = *this - y; }
  Two& operator*=(Two y) { return *this = *this * y; }
  friend auto operator<(Two x, Two y) { return masks(x.a < y.a, x.b < y.b); }
  friend auto operator>(Two x, Two y) { return masks(x.a > y.a, x.b > y.b); }
  friend auto operator<=(Two x, Two y) { return masks(x.a <= y.a, x.b <= y.b); }
  friend auto operator>=(Two x, Two y) { return masks(x.a >= y.a, x.b >= y.b); }
  template <class M>
  friend Two select(TwoMasks<M> m, Two x, Two y) { return {select(m.a, x.a, y.a), select(m.b, x.b, y.b)}; }
  friend Two min(Two x, Two y) { return {min(x.a, y.a), min(x.b, y.b)}; }
  friend Two max(Two x, Two y) { return {max(x.a, y.a), max(x.b, y.b)}; }
  friend Two abs(Two x) { return {abs(x.a), abs(x.b)}; }
  friend Two sqrt(Two x) { return {sqrt(x.a), sqrt(x.b)}; }
  friend Two exp(Two x) { return {exp(x.a), exp(x.b)}; }
  friend Two log(Two x) { return {log(x.a), log(x.b)}; }
  friend Two short_log(Two x) { return {short_log(x.a), short_log(x.b)}; }
  friend Two rough_exp(Two x) { return {rough_exp(x.a), rough_exp(x.b)}; }

 private:
  template <class M>
  static TwoMasks<M> masks(M a, M b) { return {a, b}; }
};

/// `count` points side by side: 1, 2 or 4.
template <class T, int stride, int count>
struct SideBySide {
  using Half = SideBySide<T, stride, count / 2>;
  using Type = Two<typename Half::Type, stride * count / 2>;
  static Type join(const T* p) { return {Half::join(p), Half::join(p + count / 2)}; }
  static void part(const Type& x, T* p) { Half::part(x.a, p), Half::part(x.b, p + count / 2); }
};
template <class T, int stride>
struct SideBySide<T, stride, 1> {
  using Type = T;
  static T join(const T* p) { return *p; }
  static void part(T x, T* p) { *p = x; }
};

}  // namespace bw
