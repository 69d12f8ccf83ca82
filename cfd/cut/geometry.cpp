// SPDX-License-Identifier: Apache-2.0
#include "cfd/cut/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cfd/embed/scan.h"
#include "common/app/error.h"

namespace bw::cfd {

namespace {

constexpr double snap = 1e-11;     // in cell sizes: nodes so near to a grid plane lie in it
constexpr double closed = 1e-7;    // by how much the sum along a column may miss
constexpr double nothing = 1e-13;  // apertures and what they lack to be open

/// A convex polygon in cell sizes.
struct Polygon {
  static constexpr int most = 16;
  Vec3 x[most];
  int n = 0;
  void add(const Vec3& p) { x[n++] = p; }
};

/// The part with sign (x_d - at) >= 0.
Polygon clipped(const Polygon& p, int d, double at, double sign) {
  Polygon r;
  for (int i = 0; i < p.n; ++i) {
    const Vec3 &a = p.x[i], &b = p.x[(i + 1) % p.n];
    const double s = sign * (a[d] - at), t = sign * (b[d] - at);
    if (s >= 0) r.add(a);
    if ((s > 0 && t < 0) || (s < 0 && t > 0)) {
      Vec3 q = s > 0 ? a + (b - a) * (s / (s - t)) : b + (a - b) * (t / (t - s));  // the same from either side
      q[d] = at;
      r.add(q);
    }
  }
  return r;
}

/// Splits polygons along the planes of a lattice. visit(polygon, cell): cells -1 and n of a direction reach to
/// infinity.
template <class Visit>
class Splitter {
 public:
  Splitter(const Lattice& lattice, const Visit& visit) : lattice_(lattice), visit_(visit) {}
  /// normal: into the fluid; a facet in a plane belongs to the cell on that side.
  void split(const Polygon& p, const Vec3& normal) {
    normal_ = normal;
    along(0, p, {0, 0, 0}, 0);
  }

 private:
  void along(int d, const Polygon& p, Index3 cell, int beyond) {
    if (p.n < 3) return;
    if (d == 3) return visit_(p, cell);
    if (!lattice_.active(d)) return along(d + 1, clipped(clipped(p, d, 0, 1), d, 1, -1), cell, beyond);
    double low = p.x[0][d], high = low;
    for (int i = 1; i < p.n; ++i) low = std::min(low, p.x[i][d]), high = std::max(high, p.x[i][d]);
    const int n = lattice_.n[size_t(d)];
    const auto cell_of = [&](double x) { return int(std::clamp(x, -1.0, double(n))); };
    int first = cell_of(std::floor(low)), last = cell_of(std::ceil(high) - 1);
    if (low == high && low == std::floor(low)) first = last = cell_of(normal_[d] > 0 ? low : low - 1);
    for (int i = first; i <= last; ++i) {
      const bool out = i < 0 || i == n;
      if (out && beyond) continue;  // no column of the lattice passes there
      Polygon part = p;
      if (first < last && i > first) part = clipped(part, d, i, 1);
      if (first < last && i < last) part = clipped(part, d, i + 1, -1);
      Index3 at = cell;
      at[size_t(d)] = i;
      along(d + 1, part, at, beyond + out);
    }
  }
  const Lattice& lattice_;
  const Visit& visit_;
  Vec3 normal_;
};

/// Area (with its normal as the order of corners has it), centroid and mean squares of the coordinates.
struct Moments {
  Vec3 area, at, squares;
  explicit Moments(const Polygon& p, const Vec3& origin) {
    double whole = 0;
    Vec3 along;
    for (int i = 1; i + 1 < p.n; ++i) area += 0.5 * cross(p.x[i] - p.x[0], p.x[i + 1] - p.x[0]);
    along = norm(area) > 0 ? unit(area) : Vec3{};
    for (int i = 1; i + 1 < p.n; ++i) {
      const Vec3 a = p.x[0] - origin, b = p.x[i] - origin, c = p.x[i + 1] - origin;
      const double part = 0.5 * dot(cross(b - a, c - a), along);
      whole += part;
      at += part / 3 * (a + b + c);
      for (int d = 0; d < 3; ++d)
        squares[d] += part / 6 * (a[d] * a[d] + b[d] * b[d] + c[d] * c[d] + a[d] * b[d] + b[d] * c[d] + c[d] * a[d]);
    }
    if (whole > 0) at = at / whole, squares = squares / whole;
  }
};

/// A facet and what its cell's sums need of it.
struct Part {
  Index3 cell;
  CutFacet facet;
  Vec3 squares;
};

double rounded(double open) { return std::abs(open) < nothing ? 0 : std::abs(1 - open) < nothing ? 1 : open; }

/// Facets of a surface; inside: minus a multiple of the volume that it encloses, from its areas along `used`.
std::vector<Part> parts_of(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
                           const Lattice& lattice, int used, double& inside) {
  std::vector<Vec3> X(x.size());
  for (size_t i = 0; i < x.size(); ++i)
    for (int d = 0; d < 3; ++d) {
      X[i][d] = (x[i][d] - lattice.lower[d]) / lattice.h[d];
      if (const double near = std::round(X[i][d]); std::abs(X[i][d] - near) < snap) X[i][d] = near;
      // where the flow is the same all along, a body that reaches both sides goes on beyond them
      if (!lattice.active(d) && (X[i][d] == 0 || X[i][d] == 1)) X[i][d] += X[i][d] == 0 ? -1 : 1;
    }
  std::vector<Part> parts;
  for (size_t face = 0; face < surface.quads.size(); ++face) {
    const auto& quad = surface.quads[face];
    const bool triangle = quad[2] == quad[3];
    const Vec3 v_mid =
        triangle ? v[size_t(quad[2])]
                 : 0.25 * ((v[size_t(quad[0])] + v[size_t(quad[2])]) + (v[size_t(quad[1])] + v[size_t(quad[3])]));
    for_each_triangle(X, quad, [&](const Vec3& a, const Vec3& b, const Vec3& c, int node_a, int node_b) {
      const Vec3 normal = cross(b - a, c - a);
      const double square = dot(normal, normal);
      if (!(square > 0)) return;
      inside -= normal[used] * (a[used] + b[used] + c[used]);
      const Vec3 v_a = v[size_t(quad[size_t(node_a)])], v_b = v[size_t(quad[size_t(node_b)])];
      const auto keep = [&](const Polygon& p, const Index3& cell) {
        const Vec3 origin{double(cell[0]), double(cell[1]), double(cell[2])};
        const Moments m(p, origin);
        if (!(norm(m.area) > 0)) return;
        const Vec3 at = m.at + origin;
        const double on_b = dot(cross(at - a, c - a), normal) / square,
                     on_c = dot(cross(b - a, at - a), normal) / square;
        parts.push_back({cell,
                         {int32_t(face), -1.0 * m.area, m.at, (1 - on_b - on_c) * v_a + on_b * v_b + on_c * v_mid},
                         m.squares});
      };
      Polygon p;
      p.add(a), p.add(b), p.add(c);
      Splitter(lattice, keep).split(p, normal);
    });
  }
  return parts;
}

/// Volume and centroid; squares: sum over the facets of area_d <x_d^2>.
void measure(CutVolume& c, const std::vector<CutFacet>& facets, const Vec3& squares, const Lattice& lattice, int used) {
  c.volume = c.open[used][1];
  Vec3 mean;
  double whole = 0;
  for (int32_t f = c.first; f < c.last; ++f) {
    const CutFacet& part = facets[size_t(f)];
    c.volume += part.area[used] * part.at[used];
    mean += norm(part.area) * part.at;
    whole += norm(part.area);
  }
  c.volume = std::clamp(rounded(c.volume), 0.0, 1.0);
  c.centroid = {0.5, 0.5, 0.5};
  for (int d = 0; d < 3; ++d)
    if (lattice.active(d))
      c.centroid[d] =
          c.volume > 1e-6 ? std::clamp(0.5 * (c.open[d][1] + squares[d]) / c.volume, 0.0, 1.0) : mean[d] / whole;
}

}  // namespace

int64_t CutGeometry::key(const Index3& c, int d) const {
  const size_t e = size_t(d + 1) % 3, f = size_t(d + 2) % 3;
  const bool flip = e > f;  // columns along x: by k, j, i
  const int64_t slow = c[flip ? e : f] + 1, fast = c[flip ? f : e] + 1;
  const int64_t n_fast = lattice_.n[flip ? f : e] + 2, n_along = lattice_.n[size_t(d)] + 2;
  return (slow * n_fast + fast) * n_along + c[size_t(d)] + 1;
}

void CutGeometry::build(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
                        const Lattice& lattice) {
  lattice_ = lattice;
  int used = 0;
  while (used < 2 && !lattice.active(used)) ++used;
  double inside = 0;
  std::vector<Part> parts = parts_of(surface, x, v, lattice, used, inside);
  outside_ = inside < 0 ? 1 : 0;
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const Part& a, const Part& b) { return key(a.cell, 0) < key(b.cell, 0); });
  facets_.clear();
  all_.clear();
  std::vector<Vec3> squares;  // [all_] sum of area_d <x_d^2>
  for (const Part& p : parts) {
    if (all_.empty() || all_.back().cell != p.cell) {
      all_.emplace_back();
      all_.back().cell = p.cell;
      all_.back().first = int32_t(facets_.size());
      squares.emplace_back();
    }
    facets_.push_back(p.facet);
    all_.back().last = int32_t(facets_.size());
    all_.back().area += p.facet.area;
    for (int d = 0; d < 3; ++d) squares.back()[d] += p.facet.area[d] * p.squares[d];
  }
  for (int d = 0; d < 3; ++d) march(d, all_);
  cells_.clear();
  for (size_t n = 0; n < all_.size(); ++n) {
    CutVolume& c = all_[n];
    bool within = true;
    for (size_t d = 0; d < 3; ++d) within = within && c.cell[d] >= 0 && c.cell[d] < lattice.n[d];
    if (!within) continue;
    measure(c, facets_, squares[n], lattice, used);
    cells_.push_back(c);
  }
}

void CutGeometry::march(int d, std::vector<CutVolume>& all) {
  auto& column = column_[d];
  column.clear();
  if (!lattice_.active(d)) return;
  for (size_t n = 0; n < all.size(); ++n) {
    bool passes = true;  // does a column along d pass through the lattice there?
    for (int e = 0; e < 3; ++e)
      passes = passes && (e == d || (all[n].cell[size_t(e)] >= 0 && all[n].cell[size_t(e)] < lattice_.n[size_t(e)]));
    if (passes) column.push_back({key(all[n].cell, d), int32_t(n)});
  }
  std::sort(column.begin(), column.end(), [](const Place& a, const Place& b) { return a.key < b.key; });
  const int64_t length = lattice_.n[size_t(d)] + 2;
  const auto fail = [&](const CutVolume& c) {
    const Vec3 x = lattice_.centre(c.cell);
    throw PhysicsError(
        fmt::format("walls with treatment = \"cut_cell\" are closed and don't overlap; near ({:.6g}, {:.6g}, {:.6g}) m "
                    "these do or are not",
                    x.x, x.y, x.z));
  };
  for (size_t begin = 0; begin < column.size();) {
    double open = outside_;
    Vec3 moment{0.5 * open, 0.5 * open, 0.5 * open};
    size_t n = begin;
    for (; n < column.size() && column[n].key / length == column[begin].key / length; ++n) {
      CutVolume& c = all[size_t(column[n].cell)];
      for (int upper = 0; upper < 2; ++upper) {
        if (upper)
          for (int32_t f = c.first; f < c.last; ++f) {
            const CutFacet& part = facets_[size_t(f)];
            open -= part.area[d];
            for (int e = 0; e < 3; ++e) moment[e] -= part.area[d] * part.at[e];
          }
        if (open < -closed || open > 1 + closed) fail(c);
        c.open[d][upper] = rounded(open);
        for (int e = 0; e < 3; ++e)
          c.face_at[d][upper][e] = e == d                              ? double(upper)
                                   : lattice_.active(e) && open > 1e-9 ? std::clamp(moment[e] / open, 0.0, 1.0)
                                                                       : 0.5;
      }
    }
    if (std::abs(open - outside_) > closed) fail(all[size_t(column[n - 1].cell)]);
    begin = n;
  }
}

const CutVolume* CutGeometry::find(const Index3& cell) const {
  const auto at = std::lower_bound(cells_.begin(), cells_.end(), key(cell, 0),
                                   [&](const CutVolume& c, int64_t k) { return key(c.cell, 0) < k; });
  return at != cells_.end() && at->cell == cell ? &*at : nullptr;
}

bool CutGeometry::open(const Index3& cell) const {
  for (int d = 0; d < 3; ++d) {
    const auto& column = column_[d];
    if (column.empty()) continue;
    const int64_t k = key(cell, d), length = lattice_.n[size_t(d)] + 2;
    const auto above =
        std::lower_bound(column.begin(), column.end(), k, [](const Place& p, int64_t key) { return p.key < key; });
    if (above != column.begin() && (above - 1)->key / length == k / length)
      return all_[size_t((above - 1)->cell)].open[d][1] > 0.5;
    if (above != column.end() && above->key / length == k / length) return all_[size_t(above->cell)].open[d][0] > 0.5;
  }
  return outside_ > 0;
}

}  // namespace bw::cfd
