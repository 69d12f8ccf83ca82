// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/quads.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/app/error.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/tets.h"

namespace bw::csd {

using std::numbers::pi;

Quads quad_grid(int nx, int ny) {
  Quads q;
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) q.p.push_back({double(i) / nx, double(j) / ny});
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int a = i + j * (nx + 1), b = a + nx + 1;
      q.quad.push_back({a, a + 1, b + 1, b});
    }
  return q;
}

namespace {
Quads::Point turn(Quads::Point p, int quarters) {
  for (int i = 0; i < (quarters % 4 + 4) % 4; ++i) p = {-p.y, p.x};
  return p;
}
}  // namespace

Quads::Point on_circle(int b, int n) {
  if (n % 4 != 0) return {std::cos(2 * pi * b / n), std::sin(2 * pi * b / n)};
  const int quarter = n / 4, rest = b % quarter;
  // by symmetry about 45 degrees x(b) == y(n/4 - b) bit for bit
  const auto c = [&](int k) {
    return 2 * k <= quarter ? std::cos(pi / 2 * k / quarter) : std::sin(pi / 2 * (quarter - k) / quarter);
  };
  return turn({c(rest), rest == 0 ? 0.0 : c(quarter - rest)}, b / quarter);
}

Quads quad_annulus(int around, int rings) {
  Quads q;
  for (int r = 0; r <= rings; ++r)
    for (int b = 0; b < around; ++b) {
      const auto d = on_circle(b, around);
      const double radius = 1 + double(r) / rings;
      q.p.push_back({radius * d.x, radius * d.y});
    }
  for (int r = 0; r < rings; ++r)
    for (int b = 0; b < around; ++b) {
      const int next = (b + 1) % around, in = r * around, out = in + around;
      q.quad.push_back({in + b, out + b, out + next, in + next});
    }
  return q;
}

Quads quad_disc(int core, int rings, double middle) {
  const int k = core, n = 8 * k;
  const double bulge =
      1 + 0.22 * std::min(1.0, 1 / middle - 1);  // its corner is this much farther out: between circle and square
  // point of the core's shell s in [0, 1], t in [-1, 1] along the side at +x
  const auto shell = [&](double s, double t) -> Quads::Point {
    const double angle = (1 - s) * std::atan(t) + s * pi / 4 * t,
                 corner = std::numbers::sqrt2 + (bulge - std::numbers::sqrt2) * s;
    const double rise = (1 / std::cos(pi / 4 * t) - 1) / (std::numbers::sqrt2 - 1);  // 0 at mid-side, 1 at the corner
    const double radius = s * middle * (1 + (corner - 1) * rise);
    return {radius * std::cos(angle), radius * std::sin(angle)};
  };
  Quads q;
  const auto at = [&](int i, int j) { return (i + k) + (j + k) * (2 * k + 1); };
  for (int j = -k; j <= k; ++j)
    for (int i = -k; i <= k; ++i) {
      const int s = std::max(std::abs(i), std::abs(j));
      if (s == 0)
        q.p.push_back({0, 0});
      else if (i == s && j > -s)
        q.p.push_back(shell(double(s) / k, double(j) / s));
      else if (j == s)
        q.p.push_back(turn(shell(double(s) / k, double(-i) / s), 1));
      else if (i == -s)
        q.p.push_back(turn(shell(double(s) / k, double(-j) / s), 2));
      else
        q.p.push_back(turn(shell(double(s) / k, double(i) / s), 3));
    }
  for (int j = -k; j < k; ++j)
    for (int i = -k; i < k; ++i) q.quad.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  const int first = int(q.p.size());
  for (int r = 1; r <= rings; ++r)
    for (int b = 0; b < n; ++b) {
      const double t = double(b % (2 * k) - k) / k;
      const auto in = shell(1, t);
      const double radius = std::hypot(in.x, in.y), out = radius + (1 - radius) * r / rings;
      q.p.push_back(turn({out * std::cos(pi / 4 * t), out * std::sin(pi / 4 * t)}, b / (2 * k)));
    }
  const auto ring = [&](int r, int b) {
    b %= n;
    if (r > 0) return first + (r - 1) * n + b;
    const int side = b / (2 * k), c = b % (2 * k) - k;
    return side == 0 ? at(k, c) : side == 1 ? at(-c, k) : side == 2 ? at(-k, -c) : at(c, -k);
  };
  for (int r = 0; r < rings; ++r)
    for (int b = 0; b < n; ++b) q.quad.push_back({ring(r, b), ring(r + 1, b), ring(r + 1, b + 1), ring(r, b + 1)});
  return q;
}

Quads cut_sector(const Quads& q, const std::string& sector) {
  if (sector == "full") return q;
  Quads part;
  std::vector<int32_t> number(q.p.size(), -1);
  const auto is_in = [&](int32_t i) {
    return q.p[size_t(i)].y > -1e-12 && (sector == "half" || q.p[size_t(i)].x > -1e-12);
  };
  for (const auto& quad : q.quad) {
    if (!std::all_of(quad.begin(), quad.end(), is_in)) continue;
    part.quad.push_back(quad);
    for (const int32_t i : quad) number[size_t(i)] = 0;
  }
  for (size_t i = 0; i < q.p.size(); ++i)
    if (number[i] == 0) {
      number[i] = int32_t(part.p.size());
      part.p.push_back(q.p[i]);
    }
  for (auto& quad : part.quad)
    for (int32_t& i : quad) i = number[size_t(i)];
  return part;
}

namespace {
// six tets of each swept quad: two prisms, each by the staircase of its ascending columns, so that neighbours agree
std::vector<std::array<int32_t, 4>> tets_of(const Quads& q, int layers) {
  const int32_t points = int32_t(q.p.size());
  std::vector<std::array<int32_t, 4>> tets;
  for (int l = 0; l < layers; ++l)
    for (auto quad : q.quad) {
      std::rotate(quad.begin(), std::min_element(quad.begin(), quad.end()), quad.end());
      for (std::array<int32_t, 3> t : {std::array{quad[0], quad[1], quad[2]}, std::array{quad[0], quad[2], quad[3]}}) {
        std::sort(t.begin(), t.end());
        const int32_t low = l * points, top = low + points;
        tets.push_back({low + t[0], low + t[1], low + t[2], top + t[2]});
        tets.push_back({low + t[0], low + t[1], top + t[1], top + t[2]});
        tets.push_back({low + t[0], top + t[0], top + t[1], top + t[2]});
      }
    }
  return tets;
}
}  // namespace

Swept sweep(const Quads& q, int layers, const std::function<Vec3(int, int)>& place, bool is_split) {
  Swept s;
  s.points = int(q.p.size());
  std::vector<Vec3> x;
  for (int l = 0; l <= layers; ++l)
    for (int i = 0; i < s.points; ++i) x.push_back(place(i, l));
  std::vector<std::array<int32_t, 8>> hexes;
  if (is_split) {
    TetSplit split(std::move(x), tets_of(q, layers));
    x = std::move(split.x);
    hexes = std::move(split.hexes);
    s.origin = std::move(split.origin);
  } else {
    for (int l = 0; l < layers; ++l)
      for (const auto& a : q.quad) {
        const int32_t low = l * s.points, top = low + s.points;
        hexes.push_back(
            {low + a[0], low + a[1], low + a[2], low + a[3], top + a[0], top + a[1], top + a[2], top + a[3]});
      }
    for (size_t i = 0; i < x.size(); ++i) s.origin.push_back({int32_t(i), -1, -1, -1});
  }
  Mesh& m = s.mesh;
  for (size_t n = 0; n < x.size(); ++n) {
    m.X.push_back(x[n]);
    m.node_gid.push_back(int64_t(n));
    m.parent.push_back(NodeId());
  }
  for (size_t e = 0; e < hexes.size(); ++e) {
    std::array<NodeId, 8> h;
    for (size_t a = 0; a < 8; ++a) h[a] = NodeId(hexes[e][a]);
    m.hex.push_back(h);
    m.body.push_back(0);
    m.elem_gid.push_back(int64_t(e));
  }
  return s;
}

void Swept::add_set(const std::string& name, const std::function<bool(int, int)>& holds) {
  if (boundary_.empty()) boundary_ = boundary_faces(mesh);
  csd::add_set(mesh, boundary_, name, [&](NodeId n) {
    const auto& o = origin[size_t(n.value)];
    return std::all_of(o.begin(), o.end(), [&](int32_t i) { return i < 0 || holds(i % points, i / points); });
  });
}

Vec3 along_axis(const std::string& axis, const Vec3& base, const Vec3& p) {
  return base + (axis == "x" ? Vec3{p.z, p.x, p.y} : axis == "y" ? Vec3{p.y, p.z, p.x} : p);
}
std::array<std::string, 2> cross_axes(const std::string& axis) {
  if (axis == "x") return {"y", "z"};
  if (axis == "y") return {"z", "x"};
  return {"x", "y"};
}

std::vector<double> graded(int n, double grading) {
  std::vector<double> at{0.0};
  const double ratio = n > 1 ? std::pow(grading, 1.0 / (n - 1)) : 1.0;
  for (int i = 0; i < n; ++i) at.push_back(at.back() + std::pow(ratio, i));
  const double length = at.back();
  for (double& a : at) a /= length;
  return at;
}

}  // namespace bw::csd
