// SPDX-License-Identifier: Apache-2.0
// Floating-point filters and exact fall-back of Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates" (1997); the exact part here is plain expansion arithmetic, as it runs for nearly no point.
#include "cfd/embed/predicates.h"

#include <cmath>
#include <vector>

namespace bw::cfd {
namespace {

constexpr double eps = 0x1p-53;

/// A sum of doubles without loss, smallest first, no overlap.
class Exact {
 public:
  void add(double b) {
    size_t n = 0;
    for (double a : terms_) {
      const double sum = a + b, bv = sum - a, av = sum - bv;
      const double rest = (a - av) + (b - bv);
      if (rest != 0) terms_[n++] = rest;
      b = sum;
    }
    terms_.resize(n);
    if (b != 0) terms_.push_back(b);
  }
  void add_product(double a, double b) {
    if (a == 0 || b == 0) return;
    const double p = a * b;
    add(std::fma(a, b, -p));
    add(p);
  }
  void add_product(double a, double b, double c) {
    if (a == 0 || b == 0 || c == 0) return;
    const double p = a * b;
    add_product(std::fma(a, b, -p), c);
    add_product(p, c);
  }
  int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }

 private:
  std::vector<double> terms_;
};

/// a - b = hi + lo exactly.
struct Difference {
  double part[2];
  Difference(double a, double b) {
    part[1] = a - b;
    const double bv = a - part[1], av = part[1] + bv;
    part[0] = (a - av) + (bv - b);
  }
};

int sign_of(double a) { return a > 0 ? 1 : a < 0 ? -1 : 0; }

/// Sign of (b - a) x (q - a), 0 on the line.
int exact_side(double ax, double ay, double bx, double by, double qx, double qy) {
  const double left = (bx - ax) * (qy - ay), right = (by - ay) * (qx - ax);
  const double det = left - right;
  if (std::abs(det) > (3 + 16 * eps) * eps * (std::abs(left) + std::abs(right))) return sign_of(det);
  const Difference bax(bx, ax), bay(by, ay), qax(qx, ax), qay(qy, ay);
  Exact sum;
  for (double u : bax.part)
    for (double v : qay.part) sum.add_product(u, v);
  for (double u : bay.part)
    for (double v : qax.part) sum.add_product(-u, v);
  return sum.sign();
}

}  // namespace

int side_of_line(double ax, double ay, double bx, double by, double qx, double qy) {
  if (const int s = exact_side(ax, ay, bx, by, qx, qy)) return s;
  if (by != ay) return by > ay ? -1 : 1;  // derivative to qx
  return sign_of(bx - ax);                // derivative to qy
}

int side_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& q) {
  const Vec3 u = b - a, v = c - a, w = q - a;
  const double det = triple(w, u, v);
  const double bound = std::abs(w.x) * (std::abs(u.y * v.z) + std::abs(u.z * v.y)) +
                       std::abs(w.y) * (std::abs(u.z * v.x) + std::abs(u.x * v.z)) +
                       std::abs(w.z) * (std::abs(u.x * v.y) + std::abs(u.y * v.x));
  if (std::abs(det) > (7 + 56 * eps) * eps * bound) return sign_of(det);
  Exact sum;
  const Difference d[3][3] = {
      {{b.x, a.x}, {b.y, a.y}, {b.z, a.z}}, {{c.x, a.x}, {c.y, a.y}, {c.z, a.z}}, {{q.x, a.x}, {q.y, a.y}, {q.z, a.z}}};
  constexpr int permutation[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int p = 0; p < 6; ++p)
    for (double e : d[0][permutation[p][0]].part)
      for (double f : d[1][permutation[p][1]].part)
        for (double g : d[2][permutation[p][2]].part) sum.add_product(p < 3 ? e : -e, f, g);
  if (const int s = sum.sign()) return s;
  // derivatives to q.x, q.y, q.z: the components of the normal
  if (const int s = exact_side(a.y, a.z, b.y, b.z, c.y, c.z)) return s;
  if (const int s = -exact_side(a.x, a.z, b.x, b.z, c.x, c.z)) return s;
  return exact_side(a.x, a.y, b.x, b.y, c.x, c.y);
}

}  // namespace bw::cfd
