// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace bw::cfd {
namespace {

constexpr int most_facets = 128;  // along one edge

int pieces(double length, double h, int least = 1) {
  return int(std::clamp(std::ceil(length / h - 1e-9), double(least), double(most_facets)));
}

/// Adds the patch x(u, v), u and v in [0, 1], of m x n quads; normal dx/du x dx/dv. Nodes of neighbouring patches are
/// not shared: equal coordinates are enough for a watertight scan, and merge() makes them one.
template <class Map>
void add_patch(Facets& s, int m, int n, const Map& map) {
  const int first = int(s.x.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= m; ++i) s.x.push_back(map(double(i) / m, double(j) / n));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < m; ++i) {
      const int a = first + j * (m + 1) + i, b = a + m + 1;
      s.quads.push_back({a, a + 1, b + 1, b});
    }
}

/// One node for nodes closer than `hair`; all distances between different nodes are far larger.
void merge(Facets& s, double hair) {
  using Key = std::array<int64_t, 3>;
  const double bin = 1e3 * hair;
  std::map<Key, int32_t> found;  // bins of kept nodes; a node near a bin's side is in the bins beyond it, too
  std::vector<Vec3> kept;
  std::vector<int32_t> to;
  for (const Vec3& x : s.x) {
    auto key = [&](int corner) {
      Key k;
      for (int d = 0; d < 3; ++d) k[size_t(d)] = int64_t(std::floor((x[d] + (corner >> d & 1 ? hair : -hair)) / bin));
      return k;
    };
    int32_t node = -1;
    for (int corner = 0; corner < 8 && node < 0; ++corner)
      if (const auto it = found.find(key(corner)); it != found.end() && norm(kept[size_t(it->second)] - x) <= hair)
        node = it->second;
    if (node < 0) {
      node = int32_t(kept.size());
      kept.push_back(x);
      for (int corner = 0; corner < 8; ++corner) found.emplace(key(corner), node);
    }
    to.push_back(node);
  }
  for (auto& q : s.quads)
    for (int32_t& i : q) i = to[size_t(i)];
  s.x = std::move(kept);
}

/// Unit vectors u, v with u x v = n.
void frame(const Vec3& n, Vec3& u, Vec3& v) {
  const Vec3 other = std::abs(n.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  u = unit(cross(other, n));
  v = cross(n, u);
}

/// Where an edge along the unit vector u through `point`, from -far to far, is cut into facets: of size h beside the
/// domain, one on either side of it.
std::vector<double> cuts(const ShapeSetting& s, const Vec3& point, const Vec3& u, double far) {
  double low = far, high = -far;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 x;
    for (int d = 0; d < 3; ++d) x[d] = corner >> d & 1 ? s.upper[d] : s.lower[d];
    low = std::min(low, dot(x - point, u)), high = std::max(high, dot(x - point, u));
  }
  const int n = pieces(high - low, s.h);
  std::vector<double> at{-far};
  for (int i = 0; i <= n; ++i) at.push_back(low + (high - low) * i / n);
  at.push_back(far);
  return at;
}

/// Parallelepiped with corner o and edges a, b, c (right-handed).
Facets block(const Vec3& o, const Vec3& a, const Vec3& b, const Vec3& c, double h) {
  Facets s;
  const Vec3 edge[3] = {a, b, c};
  for (int d = 0; d < 3; ++d) {
    const Vec3 &u = edge[(d + 1) % 3], &v = edge[(d + 2) % 3], &w = edge[d];
    const int m = pieces(norm(u), h), n = pieces(norm(v), h);
    add_patch(s, m, n, [&](double p, double q) { return o + w + p * u + q * v; });
    add_patch(s, n, m, [&](double p, double q) { return o + q * u + p * v; });
  }
  merge(s, 1e-9 * (norm(a) + norm(b) + norm(c)));
  return s;
}

}  // namespace

Facets BoxShape::facets(const ShapeSetting& s) const {
  const Vec3 e = upper - lower;
  return block(lower, {e.x, 0, 0}, {0, e.y, 0}, {0, 0, e.z}, s.h);
}

Facets SphereShape::facets(const ShapeSetting& s) const {
  Facets f;
  const int m = pieces(std::numbers::pi / 2 * radius, s.h, 8);
  for (int d = 0; d < 3; ++d)
    for (const double side : {1.0, -1.0})
      add_patch(f, m, m, [&](double p, double q) {
        Vec3 x;  // equiangular cube
        x[d] = side;
        x[(d + 1) % 3] = std::tan(std::numbers::pi / 4 * (2 * (side > 0 ? p : q) - 1));
        x[(d + 2) % 3] = std::tan(std::numbers::pi / 4 * (2 * (side > 0 ? q : p) - 1));
        return centre + radius * unit(x);
      });
  merge(f, 1e-9 * radius);
  return f;
}

Facets CylinderShape::facets(const ShapeSetting& s) const {
  Facets f;
  const Vec3 axis = end - start;
  Vec3 u, v;
  frame(unit(axis), u, v);
  const int around = pieces(2 * std::numbers::pi * radius, s.h, 32), along = pieces(norm(axis), s.h),
            out = pieces(radius, s.h, 4);
  auto ring = [&](double turn, double r) {
    const double a = 2 * std::numbers::pi * turn;
    return r * (std::cos(a) * u + std::sin(a) * v);
  };
  add_patch(f, around, along, [&](double p, double q) { return start + q * axis + ring(p, radius); });
  add_patch(f, out, around, [&](double p, double q) { return end + ring(q, p * radius); });
  add_patch(f, around, out, [&](double p, double q) { return start + ring(p, q * radius); });
  merge(f, 1e-9 * (radius + norm(axis)));
  return f;
}

Facets PistonShape::facets(const ShapeSetting& s) const {
  const Vec3 n = unit(normal);
  Vec3 u, v;
  frame(n, u, v);
  const double far = s.far() + norm(point - 0.5 * (s.lower + s.upper));
  // of its six sides five are out of the domain's reach; they are cut as its front is, so that they fit
  const std::vector<double> along_u = cuts(s, point, u, far), along_v = cuts(s, point, v, far);
  const int m_u = int(along_u.size()) - 1, m_v = int(along_v.size()) - 1;
  const auto at_u = [&](double p) { return along_u[size_t(std::lround(p * m_u))] * u; };
  const auto at_v = [&](double q) { return along_v[size_t(std::lround(q * m_v))] * v; };
  const Vec3 back = point - far * n;
  Facets f;
  add_patch(f, m_u, m_v, [&](double p, double q) { return point + at_u(p) + at_v(q); });
  add_patch(f, m_v, m_u, [&](double p, double q) { return back + at_u(q) + at_v(p); });
  add_patch(f, m_v, 1, [&](double p, double q) { return back + far * u + at_v(p) + q * far * n; });
  add_patch(f, 1, m_v, [&](double p, double q) { return back - far * u + at_v(q) + p * far * n; });
  add_patch(f, 1, m_u, [&](double p, double q) { return back + far * v + at_u(q) + p * far * n; });
  add_patch(f, m_u, 1, [&](double p, double q) { return back - far * v + at_u(p) + q * far * n; });
  merge(f, 1e-9 * far);
  return f;
}

Facets PlaneShape::facets(const ShapeSetting& s) const {
  const Vec3 n = unit(normal);
  Vec3 u, v;
  frame(n, u, v);
  if (const Vec3 t = along - dot(along, n) * n; norm(t) > 1e-6 * norm(along) && norm(along) > 0) {
    u = unit(t);
    v = cross(n, u);
  }
  Facets f;
  if (size.empty()) {
    const double far = s.far() + norm(point - 0.5 * (s.lower + s.upper));
    const std::vector<double> along_u = cuts(s, point, u, far), along_v = cuts(s, point, v, far);
    const int m_u = int(along_u.size()) - 1, m_v = int(along_v.size()) - 1;
    add_patch(f, m_u, m_v, [&](double p, double q) {
      return point + along_u[size_t(std::lround(p * m_u))] * u + along_v[size_t(std::lround(q * m_v))] * v;
    });
    return f;
  }
  const Vec3 a = size[0] * u, b = size[1] * v;
  add_patch(f, pieces(norm(a), s.h), pieces(norm(b), s.h),
            [&](double p, double q) { return point + (p - 0.5) * a + (q - 0.5) * b; });
  return f;
}

bool PrismShape::sides_cross() const {
  const auto side_of = [](const Vec3& a, const Vec3& b, const Vec3& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
  };
  const auto apart = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return side_of(a, b, c) * side_of(a, b, d) < 0;
  };
  const size_t n = points.size();
  for (size_t i = 0; i < n; ++i)
    for (size_t j = i + 1; j < n; ++j) {
      const Vec3 &a = points[i], &b = points[(i + 1) % n], &c = points[j], &d = points[(j + 1) % n];
      if (apart(a, b, c, d) && apart(c, d, a, b)) return true;
    }
  return false;
}

Facets PrismShape::facets(const ShapeSetting& s) const {
  std::vector<Vec3> corner = points;
  double twice_area = 0;
  for (size_t i = 0; i < corner.size(); ++i) {
    const Vec3 &a = corner[i], &b = corner[(i + 1) % corner.size()];
    twice_area += a.x * b.y - a.y * b.x;
  }
  if (twice_area < 0) std::reverse(corner.begin(), corner.end());
  const double z0 = span.empty() ? s.lower.z - s.far() : span[0], z1 = span.empty() ? s.upper.z + s.far() : span[1];
  Facets f;
  for (size_t i = 0; i < corner.size(); ++i) {
    const Vec3 a{corner[i].x, corner[i].y, 0},
        b{corner[(i + 1) % corner.size()].x, corner[(i + 1) % corner.size()].y, 0};
    const int m = pieces(norm(b - a), s.h), n = span.empty() ? 1 : pieces(z1 - z0, s.h);
    add_patch(f, m, n, [&](double p, double q) { return a + p * (b - a) + Vec3{0, 0, z0 + q * (z1 - z0)}; });
  }
  // the ends: a fan; where it folds over itself (hollow polygons) the windings cancel
  for (const bool top : {false, true}) {
    const int32_t first = int32_t(f.x.size());
    for (const Vec3& c : corner) f.x.push_back({c.x, c.y, top ? z1 : z0});
    for (int32_t i = 1; i + 1 < int32_t(corner.size()); ++i)
      f.quads.push_back(top ? std::array<int32_t, 4>{first, first + i, first + i + 1, first + i + 1}
                            : std::array<int32_t, 4>{first, first + i + 1, first + i, first + i});
  }
  merge(f, 1e-9 * (norm(points[1] - points[0]) + norm(points[2] - points[1])));
  return f;
}

Facets WedgeShape::facets(const ShapeSetting& s) const {
  const double rise = length * std::tan(angle * std::numbers::pi / 180);
  return PrismShape{{point, point + Vec3{length, 0, 0}, point + Vec3{length, rise, 0}}, {}}.facets(s);
}

}  // namespace bw::cfd
