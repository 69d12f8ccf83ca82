// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/foot.h"

namespace bw::csd {

/// Newton's method for the two coordinates in which x - p is perpendicular to the face, p = M + s A + t B + s t C.
template <class T>
Feet<T> feet_on(const Vec<T>& x, const std::array<Vec<T>, 4>& face) {
  constexpr double beside = 1 + 1e-6;  // meshes that match have nodes on edges, to round-off
  constexpr double close = 1e-9;       // the error after such a step is about its square
  // seen from a corner: far from the origin digits would be lost
  const Vec<T> q1 = face[1] - face[0], q2 = face[2] - face[0], q3 = face[3] - face[0];
  const T quarter(0.25);
  const Vec<T> A = quarter * (q1 + q2 - q3), B = quarter * (q2 + q3 - q1), C = quarter * (q2 - q1 - q3);
  const Vec<T> d = x - face[0] - quarter * (q1 + q2 + q3);
  T s(0), t(0), before(1e300), found(0);
  auto is_active = s <= T(0);
  for (int i = 0; i < 12; ++i) {
    const Vec<T> r = d - s * A - t * B - (s * t) * C, ps = A + t * C, pt = B + s * C;
    const T a = dot(ps, ps), b = dot(ps, pt) - dot(r, C), c = dot(pt, pt), det = a * c - b * b;
    const T u = dot(r, ps), v = dot(r, pt), per_det = T(1) / det;
    const T ds = (c * u - b * v) * per_det, dt = (a * v - b * u) * per_det, change = abs(ds) + abs(dt);
    const auto is_regular = det > T(1e-12) * a * c;
    s = select(is_active & is_regular, s + ds, s), t = select(is_active & is_regular, t + dt, t);
    const T far = max(abs(s), abs(t));
    const auto converges_beside = (change < T(0.25) * before) & (far > T(beside) + T(4) * change);
    is_active = is_active & is_regular & (far < T(4)) & !converges_beside;
    const auto is_there = is_active & (change <= T(close));
    found = select(is_there, T(1), found);
    is_active = is_active & !is_there;
    if (!any(is_active)) break;  // what is left after the last: as far from the face as it is curved
    before = change;
  }
  const Vec<T> r = d - s * A - t * B - (s * t) * C, area = cross(A + t * C, B + s * C);
  const T size2 = dot(area, area), root = sqrt(size2);
  const Vec<T> normal = (T(1) / root) * area;
  found = select((max(abs(s), abs(t)) <= T(beside)) & (size2 > T(0)), found, T(0));
  return {found,
          {quarter * (T(1) - s) * (T(1) - t), quarter * (T(1) + s) * (T(1) - t), quarter * (T(1) + s) * (T(1) + t),
           quarter * (T(1) - s) * (T(1) + t)},
          normal,
          dot(r, normal),
          T(2) * sqrt(root)};
}

template Feet<double> feet_on(const Vec<double>&, const std::array<Vec<double>, 4>&);
template Feet<Pack> feet_on(const Vec<Pack>&, const std::array<Vec<Pack>, 4>&);

}  // namespace bw::csd
