// SPDX-License-Identifier: Apache-2.0
// Small vectors and 3x3 tensors. T is double or Pack; no memory, no branches.
#pragma once
#include <cmath>

namespace bw {

template <class T>
struct Vec {
  T x{}, y{}, z{};
  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
  friend Vec operator*(const T& s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec operator*(const Vec& a, const T& s) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec operator/(const Vec& a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
  Vec& operator+=(const Vec& b) { return *this = *this + b; }
  Vec& operator-=(const Vec& b) { return *this = *this - b; }
  friend bool operator==(const Vec&, const Vec&) = default;
};
using Vec3 = Vec<double>;

template <class T> T dot(const Vec<T>& a, const Vec<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T triple(const Vec<T>& a, const Vec<T>& b, const Vec<T>& c) { return dot(a, cross(b, c)); }
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(const Vec3& a) { return a / norm(a); }

/// 3x3 tensor, rows a[i]; a(i, j).
template <class T>
struct Mat {
  Vec<T> row[3];
  T& operator()(int i, int j) { return row[i][j]; }
  const T& operator()(int i, int j) const { return row[i][j]; }
  static Mat identity() { return {{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}}; }
  friend Mat operator+(const Mat& a, const Mat& b) { return {{a.row[0] + b.row[0], a.row[1] + b.row[1], a.row[2] + b.row[2]}}; }
  friend Mat operator-(const Mat& a, const Mat& b) { return {{a.row[0] - b.row[0], a.row[1] - b.row[1], a.row[2] - b.row[2]}}; }
  friend Mat operator*(const T& s, const Mat& a) { return {{s * a.row[0], s * a.row[1], s * a.row[2]}}; }
  friend Vec<T> operator*(const Mat& a, const Vec<T>& v) { return {dot(a.row[0], v), dot(a.row[1], v), dot(a.row[2], v)}; }
  friend Mat operator*(const Mat& a, const Mat& b) {
    Mat c;
    for (int i = 0; i < 3; ++i) c.row[i] = a.row[i].x * b.row[0] + a.row[i].y * b.row[1] + a.row[i].z * b.row[2];
    return c;
  }
};
using Mat3 = Mat<double>;

template <class T> Mat<T> transpose(const Mat<T>& a) {
  return {{{a(0, 0), a(1, 0), a(2, 0)}, {a(0, 1), a(1, 1), a(2, 1)}, {a(0, 2), a(1, 2), a(2, 2)}}};
}
template <class T> T trace(const Mat<T>& a) { return a(0, 0) + a(1, 1) + a(2, 2); }
template <class T> T det(const Mat<T>& a) { return triple(a.row[0], a.row[1], a.row[2]); }
/// Cofactor matrix: cof(A) = det(A) A^-T.
template <class T> Mat<T> cofactor(const Mat<T>& a) {
  return {{cross(a.row[1], a.row[2]), cross(a.row[2], a.row[0]), cross(a.row[0], a.row[1])}};
}
template <class T> Mat<T> inverse(const Mat<T>& a) { return (T(1) / det(a)) * transpose(cofactor(a)); }

/// Symmetric 3x3 tensor.
template <class T>
struct Sym {
  T xx{}, yy{}, zz{}, xy{}, xz{}, yz{};
  friend Sym operator+(const Sym& a, const Sym& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend Sym operator-(const Sym& a, const Sym& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
  }
  friend Sym operator*(const T& s, const Sym& a) {
    return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
  }
  friend Vec<T> operator*(const Sym& a, const Vec<T>& v) {
    return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z, a.xz * v.x + a.yz * v.y + a.zz * v.z};
  }
};
using Sym3 = Sym<double>;
template <class T> T trace(const Sym<T>& a) { return a.xx + a.yy + a.zz; }
/// a : b
template <class T> T contract(const Sym<T>& a, const Sym<T>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + T(2) * (a.xy * b.xy + a.xz * b.xz + a.yz * b.yz);
}
template <class T> T det(const Sym<T>& a) {
  return a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
}
template <class T> Sym<T> deviator(const Sym<T>& a) {
  const T m = trace(a) * T(1.0 / 3.0);
  return {a.xx - m, a.yy - m, a.zz - m, a.xy, a.xz, a.yz};
}

}  // namespace bw
