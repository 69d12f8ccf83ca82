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
  typedef float FU __attribute__((vector_size(pack_size * 4), aligned(4), may_alias));
  static Pack load(const float* p) { return Pack(__builtin_convertvector(*reinterpret_cast<const FU*>(p), V)); }
  void store(float* p) const { *reinterpret_cast<FU*>(p) = __builtin_convertvector(v, FU); }
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
#if defined(__AVX__) && !defined(__AVX512F__)
  return __builtin_ia32_movmskpd256(Pack::V(m.v)) != 0;
#else
  int64_t r = 0;
  for (int i = 0; i < Pack::size; ++i) r |= m.v[i];
  return r != 0;
#endif
}
inline bool all(Mask m) { return !any(!m); }
inline Pack select(Mask m, Pack a, Pack b) {
#if defined(__AVX__) && !defined(__AVX512F__)
  return __builtin_ia32_blendvpd256(b.v, a.v, Pack::V(m.v));  // a mask's lanes are all ones or zeros: no test for zero
#else
  return m.v ? a.v : b.v;
#endif
}
inline Pack min(Pack a, Pack b) { return a.v < b.v ? a.v : b.v; }
inline Pack max(Pack a, Pack b) { return a.v > b.v ? a.v : b.v; }
inline Pack abs(Pack a) { return max(a, -a); }
inline Pack sqrt(Pack a) {
  Pack r;
  for (int i = 0; i < Pack::size; ++i) r.v[i] = std::sqrt(a.v[i]);
  return r;
}

namespace detail {
typedef double Quad __attribute__((vector_size(32)));
typedef double QuadU __attribute__((vector_size(32), aligned(8), may_alias));
inline Pack::V as_pack(Quad a, [[maybe_unused]] Quad b) {
#if defined(__AVX512F__)
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
#else
  return a;
#endif
}
}  // namespace detail

/// x, y, z of Pack::size points: the l-th at base + 3 at[l]. Reads one double beyond each.
inline void load_points(const double* base, const int32_t* at, Pack& x, Pack& y, Pack& z) {
  using namespace detail;
  Quad part[3][Pack::size / 4];
  for (int h = 0; h < Pack::size / 4; ++h) {
    const auto load = [&](int l) { return Quad(*reinterpret_cast<const QuadU*>(base + 3 * int64_t(at[4 * h + l]))); };
    const Quad a = load(0), b = load(1), c = load(2), d = load(3);
    const Quad xz0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), xz1 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    const Quad y0 = __builtin_shufflevector(a, b, 1, 5, 3, 7), y1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    part[0][h] = __builtin_shufflevector(xz0, xz1, 0, 1, 4, 5);
    part[1][h] = __builtin_shufflevector(y0, y1, 0, 1, 4, 5);
    part[2][h] = __builtin_shufflevector(xz0, xz1, 2, 3, 6, 7);
  }
  constexpr int last = Pack::size / 4 - 1;
  x.v = as_pack(part[0][0], part[0][last]), y.v = as_pack(part[1][0], part[1][last]),
  z.v = as_pack(part[2][0], part[2][last]);
}

/// A point with room for a fourth number, so that it is added to in one go.
struct alignas(32) PaddedPoint {
  double x = 0, y = 0, z = 0, unused = 0;
};
/// Adds x, y, z to points[at[l]] for the first `count` lanes, one after the other.
inline void add_points(PaddedPoint* points, const int32_t* at, int count, Pack x, Pack y, Pack z) {
  using namespace detail;
  const auto half = [](Pack p, int h) {
    Quad q;
    for (int i = 0; i < 4; ++i) q[i] = p.v[4 * h + i];
    return q;
  };
  const auto add = [&](int l, Quad value) {
    Quad& to = *reinterpret_cast<Quad*>(&points[at[l]]);
    to = to + value;
  };
  for (int h = 0; h < Pack::size / 4; ++h) {
    const Quad X = half(x, h), Y = half(y, h), Z = half(z, h), none{};
    const Quad xy02 = __builtin_shufflevector(X, Y, 0, 4, 2, 6), xy13 = __builtin_shufflevector(X, Y, 1, 5, 3, 7);
    const Quad z02 = __builtin_shufflevector(Z, none, 0, 4, 2, 6), z13 = __builtin_shufflevector(Z, none, 1, 5, 3, 7);
    const Quad rows[4] = {
        __builtin_shufflevector(xy02, z02, 0, 1, 4, 5), __builtin_shufflevector(xy13, z13, 0, 1, 4, 5),
        __builtin_shufflevector(xy02, z02, 2, 3, 6, 7), __builtin_shufflevector(xy13, z13, 2, 3, 6, 7)};
    for (int l = 0; l < 4; ++l)
      if (4 * h + l < count) add(4 * h + l, rows[l]);
  }
}

// The same words for double, so that a kernel template reads the same for both.
inline bool any(bool m) { return m; }
inline bool all(bool m) { return m; }
inline double select(bool m, double a, double b) { return m ? a : b; }
inline double min(double a, double b) { return a < b ? a : b; }
inline double max(double a, double b) { return a > b ? a : b; }
inline double abs(double a) { return a < 0 ? -a : a; }
using std::sqrt;
/// T = double or wider.
template <class T> T load(const double* p) {
  if constexpr (sizeof(T) == sizeof(double)) return *p;
  else return T::load(p);
}
template <class T> void store(double* p, T a) {
  if constexpr (sizeof(T) == sizeof(double)) *p = a;
  else a.store(p);
}

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
/// y[i] = r[i]^(-1/6), r > 0: linear guess on the bits (within 3.5 %), then two steps of the series of (1 - h)^(-1/6),
/// h = 1 - r y^6: within 2e-5, then to round-off. N at a time, step by step, so that their dependent chains overlap.
template <class V, class I, int N> void inverse_sixth_roots(const V* r, V* y) {
  V h[N];
  const auto miss = [&] {
    for (int i = 0; i < N; ++i) {
      const V y3 = y[i] * y[i] * y[i];
      h[i] = 1.0 - (r[i] * y3) * y3;
    }
  };
  for (int i = 0; i < N; ++i) {
    const V guess = bits_as_number<V, I>(r[i]) * (-1.0 / 6.0) + (7.0 / 6.0 * 1023.0 - 0.0502) * 0x1p32;
    y[i] = number_as_bits<V, I>(guess);
  }
  miss();
  for (int i = 0; i < N; ++i)
    y[i] = y[i] + (y[i] * h[i]) * (1.0 / 6 + h[i] * (7.0 / 72 + h[i] * (91.0 / 1296 + h[i] * (1729.0 / 31104))));
  miss();
  for (int i = 0; i < N; ++i) y[i] = y[i] + (y[i] * h[i]) * (1.0 / 6 + h[i] * (7.0 / 72 + h[i] * (91.0 / 1296)));
}
}  // namespace detail

/// y[i] = r[i]^(-1/6) for r > 0; the same operations in every lane and for double.
template <int N> void inverse_sixth_roots(const Pack (&r)[N], Pack (&y)[N]) {
  constexpr int group = N % 4 ? N : 4;
  for (int i = 0; i < N; i += group) detail::inverse_sixth_roots<Pack::V, Mask::V, group>(&r[i].v, &y[i].v);
}
template <int N> void inverse_sixth_roots(const double (&r)[N], double (&y)[N]) {
  for (int i = 0; i < N; ++i) {
    const detail::D1 ri{r[i]};
    detail::D1 yi;
    detail::inverse_sixth_roots<detail::D1, detail::I1, 1>(&ri, &yi);
    y[i] = yi[0];
  }
}
template <class T> T inverse_sixth_root(T r) {
  const T from[1] = {r};
  T y[1];
  inverse_sixth_roots(from, y);
  return y[0];
}
/// r^(-1/3) for r > 0.
template <class T> T rcbrt(T r) {
  const T y = inverse_sixth_root(r);
  return y * y;
}

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

// Short ones, for guesses that a better step follows.
namespace detail {
template <class V, class I> V short_log(V x) {
  const I b = I(x), sqrt_half = I{} + 0x3fe6a09e667f3bcd, e = (b - sqrt_half) >> 52;
  const V t = V(b - (e << 52)) - 1.0;  // in [sqrt(1/2), sqrt(2)) - 1
  const V shift = 0x1.8p52 - V{}, k = V(e + I(shift)) - shift;
  return k * 0.69314718055994530942 + t * (0.99927381 + t * (-0.50249902 + t * (0.35948028 - t * 0.22879209)));
}
template <class V> V bits_of_exp(V x) { return x * (0x1p32 / 0.6931471805599453) + (1023 - 0.043) * 0x1p32; }
}  // namespace detail
/// ln x to within 1e-4; x > 0 and normal.
inline Pack short_log(Pack x) { return detail::short_log<Pack::V, Mask::V>(x.v); }
inline double short_log(double x) { return detail::short_log<detail::D1, detail::I1>(detail::D1{x})[0]; }
/// e^x to within 4 %; |x| < 700.
inline Pack rough_exp(Pack x) { return detail::number_as_bits<Pack::V, Mask::V>(detail::bits_of_exp(x.v)); }
inline double rough_exp(double x) {
  return detail::number_as_bits<detail::D1, detail::I1>(detail::bits_of_exp(detail::D1{x}))[0];
}

}  // namespace bw
