// SPDX-License-Identifier: Apache-2.0
// Pack: as many doubles as one machine register holds. Physics kernels are templates over T = double or Pack; the loop
// over packs stands outside them. `lanes` is the storage width of every AoSoA array, whatever the machine, so that
// files, blocks and sums do not depend on it; a kernel walks a row of `lanes` in steps of Pack::size.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

namespace bw {

inline constexpr int lanes = 8;

#if defined(__AVX512F__)
inline constexpr int pack_size = 8;
#else
inline constexpr int pack_size = 4;
#endif

struct Mask;

struct Pack {
  static constexpr int size = pack_size;
  typedef double V __attribute__((vector_size(pack_size * 8)));
  typedef double VU __attribute__((vector_size(pack_size * 8), aligned(8), may_alias));
  V v;
  Pack() = default;
  Pack(double a) { v = a - V{}; }
  Pack(V a) : v(a) {}
  /// Any alignment.
  static Pack load(const double* p) { return Pack(V(*reinterpret_cast<const VU*>(p))); }
  void store(double* p) const { *reinterpret_cast<VU*>(p) = v; }
  double operator[](int i) const { return v[i]; }
  void set(int i, double a) { v[i] = a; }
  friend Pack operator+(Pack a, Pack b) { return a.v + b.v; }
  friend Pack operator-(Pack a, Pack b) { return a.v - b.v; }
  friend Pack operator*(Pack a, Pack b) { return a.v * b.v; }
  friend Pack operator/(Pack a, Pack b) { return a.v / b.v; }
  friend Pack operator-(Pack a) { return -a.v; }
  Pack& operator+=(Pack b) { v += b.v; return *this; }
  Pack& operator-=(Pack b) { v -= b.v; return *this; }
  Pack& operator*=(Pack b) { v *= b.v; return *this; }
};

struct Mask {
  typedef int64_t V __attribute__((vector_size(pack_size * 8)));
  V v;
  friend Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
  friend Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }
  friend Mask operator!(Mask a) { return {~a.v}; }
  bool operator[](int i) const { return v[i] != 0; }
};
inline Mask operator<(Pack a, Pack b) { return {a.v < b.v}; }
inline Mask operator>(Pack a, Pack b) { return {a.v > b.v}; }
inline Mask operator<=(Pack a, Pack b) { return {a.v <= b.v}; }
inline Mask operator>=(Pack a, Pack b) { return {a.v >= b.v}; }
inline bool any(Mask m) {
  int64_t r = 0;
  for (int i = 0; i < Pack::size; ++i) r |= m.v[i];
  return r != 0;
}
inline bool all(Mask m) { return !any(!m); }
inline Pack select(Mask m, Pack a, Pack b) { return m.v ? a.v : b.v; }
inline Pack min(Pack a, Pack b) { return a.v < b.v ? a.v : b.v; }
inline Pack max(Pack a, Pack b) { return a.v > b.v ? a.v : b.v; }
inline Pack abs(Pack a) { return max(a, -a); }
inline Pack sqrt(Pack a) {
  Pack r;
  for (int i = 0; i < Pack::size; ++i) r.v[i] = std::sqrt(a.v[i]);
  return r;
}

// The same words for double, so that a kernel template reads the same for both.
inline bool any(bool m) { return m; }
inline bool all(bool m) { return m; }
inline double select(bool m, double a, double b) { return m ? a : b; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double abs(double a) { return a < 0 ? -a : a; }
using std::sqrt;

namespace detail {
typedef int64_t I1 __attribute__((vector_size(8)));
typedef double D1 __attribute__((vector_size(8)));
/// Bits of a double read as one fixed-point number exponent.mantissa: log2 to within 0.09.
template <class V, class I> V bits_as_number(V a) {
  const I hi = I(a) >> 20;  // 2^32 * (exponent + mantissa), as an integer below 2^44
  const V magic = 0x1p52 - V{};
  return V(hi | I(magic)) - magic;  // exact: the integer is put into the mantissa of 2^52
}
template <class V, class I> V number_as_bits(V n) {
  const V magic = 0x1p52 - V{};
  return V((I(n + magic) ^ I(magic)) << 20);
}
/// r^(-1/3), r > 0: linear guess on the bits, then three steps of third order. Relative error below 1e-15.
template <class V, class I> V rcbrt(V r) {
  const V guess = bits_as_number<V, I>(r) * (-1.0 / 3.0) + (4.0 / 3.0 * 1023.0 - 0.044) * 0x1p32;
  V y = number_as_bits<V, I>(guess);
  for (int k = 0; k < 3; ++k) {
    const V h = 1.0 - r * y * (y * y);
    y = y + y * h * (1.0 / 3.0 + h * (2.0 / 9.0));
  }
  return y;
}
}  // namespace detail

/// r^(-1/3) for r > 0; the same operations in every lane and for double.
inline Pack rcbrt(Pack r) { return detail::rcbrt<Pack::V, Mask::V>(r.v); }
inline double rcbrt(double r) { return detail::rcbrt<detail::D1, detail::I1>(detail::D1{r})[0]; }

namespace detail {
template <class V, class I> V exp(V x) {
  // 2^k e^r, |r| <= ln2/2, Taylor to r^13: relative error below 1e-15 for |x| < 700
  const V lo = -700.0 - V{}, hi = 700.0 - V{};
  x = x < lo ? lo : x;
  x = x > hi ? hi : x;
  const V shift = 0x1.8p52 - V{};
  const V t = x * 1.4426950408889634 + shift;
  const V k = t - shift;
  V r = x - k * 0.693147180369123816490;
  r = r - k * 1.90821492927058770002e-10;
  V p = 1.0 / 6227020800.0 - V{};
  constexpr double c[] = {1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040, 1.0 / 720,
                          1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0};
  for (double a : c) p = p * r + a;
  const I bits = (I(t) << 52) + (I{} + 0);
  return V(I(p) + bits);  // add k to the exponent
}
template <class V, class I> V log(V x) {
  const I b = I(x);
  const I sqrt_half = I{} + 0x3fe6a09e667f3bcd;
  const I e = (b - sqrt_half) >> 52;  // arithmetic shift: floor
  const V m = V(b - (e << 52));       // in [sqrt(1/2), sqrt(2))
  const V shift = 0x1.8p52 - V{};
  const V k = V(e + I(shift)) - shift;
  const V t = (m - 1.0) / (m + 1.0), t2 = t * t;
  V p = 1.0 / 21 - V{};
  constexpr double c[] = {1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0};
  for (double a : c) p = p * t2 + a;
  return k * 0.69314718055994530942 + 2.0 * t * p;
}
}  // namespace detail

inline Pack exp(Pack x) { return detail::exp<Pack::V, Mask::V>(x.v); }
inline double exp(double x) { return detail::exp<detail::D1, detail::I1>(detail::D1{x})[0]; }
/// x > 0 and normal.
inline Pack log(Pack x) { return detail::log<Pack::V, Mask::V>(x.v); }
inline double log(double x) { return detail::log<detail::D1, detail::I1>(detail::D1{x})[0]; }

}  // namespace bw
