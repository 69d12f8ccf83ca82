// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/apertures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "cfd/embed/scan.h"

namespace bw::cfd {
namespace {

constexpr double hair = 1e-9;  ///< of a cell face: blocked or open by less is round-off

constexpr double bend = 0.7;  ///< cosine between the faces of an edge below which a wall may end there

/// What is known of one link: areas over that of its cell face, and the largest piece of a wall in its box.
struct Blocked {
  double thin = 0, up = 0, down = 0;  ///< by faces without thickness, and by closed bodies' that look up or down
  double place = 0;                   ///< area times distance from the lower centre
  double largest = 0;
  int32_t face = -1;
  OnFace at;
  Vec3 n;
};

class Search {
 public:
  Search(const coupling::WetSurface& s, Slits slits, CutMap& map)
      : s_(s), g_(map.lattice()), slits_(slits), map_(map) {}

  void operator()() {
    mark_edges();
    if (links_.empty()) return;
    for (size_t f = 0; f < s_.quads.size(); ++f)
      for_each_triangle(s_.x, s_.quads[f], [&](const Vec3& a, const Vec3& b, const Vec3& c, int corner, int) {
        add_triangle(int32_t(f), {a, b, c}, corner);
      });
    std::vector<std::pair<uint64_t, const Blocked*>> found;
    for (const auto& [key, blocked] : links_) found.push_back({key, &blocked});
    std::sort(found.begin(), found.end());
    for (const auto& [key, blocked] : found) finish(key, *blocked);
  }

 private:
  uint64_t key(const Index3& c, int d) const {
    return ((uint64_t(c[2]) * uint64_t(g_.n[1]) + uint64_t(c[1])) * uint64_t(g_.n[0]) + uint64_t(c[0])) * 3 +
           uint64_t(d);
  }
  /// visit(c) for the links of direction d whose box meets [lower, upper] (a hair more), inside the lattice.
  template <class Visit>
  void for_each_link(int d, const Vec3& lower, const Vec3& upper, const Visit& visit) const {
    Index3 first, last;
    for (int e = 0; e < 3; ++e) {
      const size_t i = size_t(e);
      const double shift = e == d ? 0.5 : 0.0, most = g_.n[i] - (e == d ? 2 : 1);
      first[i] = int(std::clamp(std::floor((lower[e] - g_.lower[e]) / g_.h[e] - shift - hair), 0.0, most + 1));
      last[i] = int(std::clamp(std::floor((upper[e] - g_.lower[e]) / g_.h[e] - shift + hair), -1.0, most));
    }
    Index3 c;
    for (c[2] = first[2]; c[2] <= last[2]; ++c[2])
      for (c[1] = first[1]; c[1] <= last[1]; ++c[1])
        for (c[0] = first[0]; c[0] <= last[0]; ++c[0]) visit(c);
  }

  bool thin(int32_t face) const { return !s_.flags.empty() && (s_.flags[size_t(face)] & coupling::face_thin) != 0; }

  /// Edges of one face only, and edges where the surface bends: walls end there, as seen along a grid line.
  void mark_edges() {
    struct Edge {
      std::array<int32_t, 2> node;
      Vec3 n;
      bool operator<(const Edge& o) const { return node < o.node; }
    };
    std::vector<Edge> edges;
    for (const auto& q : s_.quads) {
      const Vec3 area = coupling::area_vector(s_.x, q);
      const double size = norm(area);
      if (size == 0) continue;
      for (size_t i = 0; i < 4; ++i)
        if (const auto [a, b] = std::minmax(q[i], q[(i + 1) % 4]); a != b) edges.push_back({{a, b}, area / size});
    }
    std::stable_sort(edges.begin(), edges.end());
    for (size_t first = 0, end; first < edges.size(); first = end) {
      bool flat = true;
      for (end = first + 1; end < edges.size() && edges[end].node == edges[first].node; ++end)
        flat = flat && dot(edges[first].n, edges[end].n) > bend;
      if (end == first + 1 || !flat) mark(s_.x[size_t(edges[first].node[0])], s_.x[size_t(edges[first].node[1])]);
    }
  }

  void mark(const Vec3& a, const Vec3& b) {
    double cells = 1;
    for (int d = 0; d < 3; ++d)
      if (g_.active(d)) cells = std::max(cells, std::abs(b[d] - a[d]) / g_.h[d]);
    const int parts = int(std::min(std::ceil(cells), 1e6));
    for (int p = 0; p < parts; ++p) {
      const Vec3 from = a + double(p) / parts * (b - a), to = a + double(p + 1) / parts * (b - a);
      Vec3 lower, upper;
      for (int e = 0; e < 3; ++e) std::tie(lower[e], upper[e]) = std::minmax({from[e], to[e]});
      for (int d = 0; d < 3; ++d)
        if (g_.active(d)) for_each_link(d, lower, upper, [&](const Index3& c) { links_.try_emplace(key(c, d)); });
    }
  }

  struct Triangle {
    Vec3 a, b, c;
  };
  void add_triangle(int32_t face, const Triangle& t, int corner) {
    Vec3 lower, upper;
    for (int e = 0; e < 3; ++e) std::tie(lower[e], upper[e]) = std::minmax({t.a[e], t.b[e], t.c[e]});
    for (int d = 0; d < 3; ++d)
      if (g_.active(d))
        for_each_link(d, lower, upper, [&](const Index3& c) {
          if (const auto it = links_.find(key(c, d)); it != links_.end()) add_piece(face, t, corner, c, d, it->second);
        });
  }

  /// The part of the triangle in the box of a link.
  void add_piece(int32_t face, const Triangle& t, int corner, const Index3& cell, int d, Blocked& sum) const {
    Vec3 points[16], kept[16];
    int n = 3;
    points[0] = t.a, points[1] = t.b, points[2] = t.c;
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    for (int e = 0; e < 3 && n > 0; ++e)
      for (const double sign : {1.0, -1.0}) {
        const double lower = g_.lower[e] + (cell[size_t(e)] + (e == d ? 0.5 : 0.0)) * g_.h[e];
        const double bound = sign > 0 ? lower : lower + g_.h[e];
        int m = 0;
        for (int i = 0; i < n; ++i) {
          const Vec3 &p = points[i], &q = points[(i + 1) % n];
          const double inside_p = sign * (p[e] - bound), inside_q = sign * (q[e] - bound);
          if (inside_p >= 0) kept[m++] = p;
          if ((inside_p > 0 && inside_q < 0) || (inside_p < 0 && inside_q > 0))
            kept[m++] = p + inside_p / (inside_p - inside_q) * (q - p);
        }
        n = m;
        std::copy_n(kept, n, points);
      }
    // what lies in the plane of a centre is below it, as for cut links
    const double below = g_.centre(d, cell[size_t(d)]);
    if (std::all_of(points, points + n, [&](const Vec3& p) { return p[d] <= below; })) return;
    double area = 0;
    Vec3 centre;
    for (int i = 0; i < n; ++i) {
      const Vec3 p = points[i] - points[0], q = points[(i + 1) % n] - points[0];
      area += 0.5 * (p[u] * q[v] - p[v] * q[u]);
      centre += 1.0 / n * points[i];
    }
    area /= g_.h[u] * g_.h[v];
    if (area == 0) return;
    const double size = std::abs(area);
    (thin(face) ? sum.thin : area > 0 ? sum.up : sum.down) += size;
    sum.place += size * ((centre[d] - g_.lower[d]) / g_.h[d] - 0.5 - cell[size_t(d)]);
    if (size <= sum.largest) return;
    sum.largest = size;
    sum.face = face;
    const Vec3 normal = cross(t.b - t.a, t.c - t.a);
    sum.n = unit(normal);
    const double whole = dot(normal, normal);
    sum.at = {corner, dot(cross(centre - t.a, t.c - t.a), normal) / whole,
              dot(cross(t.b - t.a, centre - t.a), normal) / whole};
  }

  void finish(uint64_t key, const Blocked& b) {
    const int d = int(key % 3);
    key /= 3;
    const Index3 low{int(key % uint64_t(g_.n[0])), int(key / uint64_t(g_.n[0]) % uint64_t(g_.n[1])),
                     int(key / (uint64_t(g_.n[0]) * uint64_t(g_.n[1])))};
    Index3 high = low;
    ++high[size_t(d)];
    const double area = b.thin + b.up + b.down, open = 1 - (b.thin + std::max(b.up, b.down));
    const CutLink* cut = map_.link(low, d);
    if (map_.blocked(low) || map_.blocked(high) || area < hair || (cut && (open < hair || slits_ == Slits::sealed)))
      return;
    Aperture a{low, d, slits_ == Slits::sealed ? 0.0 : std::max(open, 0.0), {}};
    if (cut) {
      a.link = *cut;
    } else {
      const double s = std::clamp(b.place / area, 0.0, 1.0);
      const Vec3 up = b.n[d] > 0 ? b.n : -b.n;
      a.link = {{s, -up, {}, b.face}, {1 - s, up, {}, b.face}, b.at, b.at};
    }
    map_.add_aperture(a);
  }

  const coupling::WetSurface& s_;
  const Lattice& g_;
  Slits slits_;
  CutMap& map_;
  std::unordered_map<uint64_t, Blocked> links_;
};

}  // namespace

void find_apertures(const coupling::WetSurface& surface, Slits slits, CutMap& map) {
  Search(surface, slits, map)();
  if (!map.apertures().empty()) update_velocities(surface, map);
}

}  // namespace bw::cfd
