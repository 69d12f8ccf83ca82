// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/scan.h"

#include <algorithm>
#include <cmath>

#include "cfd/embed/predicates.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

/// A grid line in direction d, between centres i and i + 1, meets a triangle.
struct Crossing {
  uint64_t line;  // v * n_u + u
  int32_t i;      // -2: below the lattice, n: above
  int32_t face;
  double at;  // in cell sizes from centre i, in [0, 1]
  Vec3 n;     // unit normal of the face, turned with the triangle
  OnFace on;
  bool up;  // the triangle's normal points along +d
  bool thin;
};

struct Face {
  const coupling::WetSurface& s;
  const std::array<int32_t, 4>& q;
  int32_t id;
  Vec3 area;
  bool thin;
};

using Ranges = std::array<Centres::Range, 3>;  // by axis

/// In the smallest box around the points.
template <class... Points>
Ranges centres_in_box(const Centres& centres, const Points&... x) {
  Ranges r;
  for (int d = 0; d < 3; ++d) r[size_t(d)] = centres.between(d, std::min({x[d]...}), std::max({x[d]...}));
  return r;
}
/// A grid line through the box needs a centre along both other axes.
bool meets_no_line(const Ranges& r) { return r[0].empty() + r[1].empty() + r[2].empty() > 1; }

/// Lines of direction d through one triangle of a face.
class LineScan {
 public:
  LineScan(const Lattice& g, int d, std::vector<Crossing>& out)
      : g_(g), d_(d), u_(d == 0 ? 1 : 0), v_(d == 2 ? 1 : 2), out_(out) {}

  /// within: centres in the triangle's box.
  void operator()(const Face& f, const Vec3& a, const Vec3& b, const Vec3& c, int corner, const Ranges& within) const {
    const Centres::Range ru = within[size_t(u_)], rv = within[size_t(v_)];
    for (int iv = rv.first; iv <= rv.last; ++iv)
      for (int iu = ru.first; iu <= ru.last; ++iu) {
        const double qu = g_.centre(u_, iu), qv = g_.centre(v_, iv);
        const int s = side_of_line(a[u_], a[v_], b[u_], b[v_], qu, qv);
        if (s == 0 || side_of_line(b[u_], b[v_], c[u_], c[v_], qu, qv) != s ||
            side_of_line(c[u_], c[v_], a[u_], a[v_], qu, qv) != s)
          continue;
        add(f, a, b, c, corner, iu, iv, qu, qv, s);
      }
  }

 private:
  void add(const Face& f, const Vec3& a, const Vec3& b, const Vec3& c, int corner, int iu, int iv, double qu, double qv,
           int s) const {
    auto weight = [&](const Vec3& p, const Vec3& r) {
      return std::abs((p[u_] - qu) * (r[v_] - qv) - (p[v_] - qv) * (r[u_] - qu));
    };
    double wa = weight(b, c), wb = weight(c, a), wc = weight(a, b);
    const double sum = wa + wb + wc;
    if (sum > 0)
      wa /= sum, wb /= sum, wc /= sum;
    else
      wa = wb = wc = 1.0 / 3;
    const double lo = std::min({a[d_], b[d_], c[d_]}), hi = std::max({a[d_], b[d_], c[d_]});
    const double z = std::clamp(wa * a[d_] + wb * b[d_] + wc * c[d_], lo, hi);
    const bool up = (s > 0) != (d_ == 1);  // (u, v) is (z, x) turned for d = y

    // the last centre below the crossing, decided exactly
    const double index = std::clamp((z - g_.lower[d_]) / g_.h[d_] - 0.5, -1.5, double(g_.n[d_]) + 0.5);
    int i = int(std::floor(index));
    Vec3 q;
    q[u_] = qu, q[v_] = qv;
    auto above_centre = [&](int k) {
      q[d_] = g_.centre(d_, k);
      return (side_of_triangle(a, b, c, q) < 0) == up;
    };
    if (i >= -1 && i <= g_.n[d_]) {
      while (i >= -1 && !above_centre(i)) --i;
      while (i < g_.n[d_] && above_centre(i + 1)) ++i;
    }
    Crossing x;
    x.line = uint64_t(iv) * uint64_t(g_.n[u_]) + uint64_t(iu);
    x.i = i;
    x.face = f.id;
    x.at = std::clamp(index - i, 0.0, 1.0);
    x.up = up;
    x.thin = f.thin;
    if (i >= -1 && i < g_.n[d_]) {  // else only the winding number counts
      const Vec3 t = cross(b - a, c - a);
      const double at = norm(t), af = norm(f.area);
      // the mean normal of the quad is smoother, unless it is folded
      x.n = dot(t, f.area) > 0.5 * at * af && (f.area[d_] > 0) == (t[d_] > 0) ? f.area / af : t / at;
      x.on = {corner, wb, wc};
    }
    out_.push_back(x);
  }

  const Lattice& g_;
  const int d_, u_, v_;
  std::vector<Crossing>& out_;
};

/// Of one chunk of faces, by direction.
using Crossings = std::array<std::vector<Crossing>, 3>;

/// Of faces [first, last), unsorted.
Crossings crossings(const coupling::WetSurface& s, const Lattice& g, size_t first, size_t last) {
  Crossings out;
  const Centres centres(g);
  const LineScan lines[3] = {{g, 0, out[0]}, {g, 1, out[1]}, {g, 2, out[2]}};
  for (size_t f = first; f < last; ++f) {
    const auto& q = s.quads[f];
    if (meets_no_line(centres_in_box(centres, s.x[size_t(q[0])], s.x[size_t(q[1])], s.x[size_t(q[2])], s.x[size_t(q[3])])))
      continue;
    const Face face{s, q, int32_t(f), coupling::area_vector(s.x, q),
                    !s.flags.empty() && (s.flags[f] & coupling::face_thin) != 0};
    for_each_triangle(s.x, q, [&](const Vec3& a, const Vec3& b, const Vec3& c, int corner, int) {
      const Ranges within = centres_in_box(centres, a, b, c);
      if (meets_no_line(within)) return;
      for (int d = 0; d < 3; ++d)
        if (g.active(d) || d == 0) lines[d](face, a, b, c, corner, within);
    });
  }
  return out;
}

/// Of all chunks in direction d, by line and along it.
std::vector<Crossing> sorted(const std::vector<Crossings>& chunks, size_t d) {
  struct Key {
    uint64_t line;
    double at;
    int32_t i, face;
    const Crossing* of;
    bool operator<(const Key& o) const {
      if (line != o.line) return line < o.line;
      if (i != o.i) return i < o.i;
      return at != o.at ? at < o.at : face < o.face;
    }
  };
  std::vector<Key> keys;
  for (const Crossings& chunk : chunks)
    for (const Crossing& x : chunk[d]) keys.push_back({x.line, x.at, x.i, x.face, &x});
  std::sort(keys.begin(), keys.end());
  std::vector<Crossing> all;
  all.reserve(keys.size());
  for (const Key& k : keys) all.push_back(*k.of);
  return all;
}

/// body(first, last) for each run of crossings with equal key.
template <class Key, class Body>
void for_each_run(const Crossing* first, const Crossing* last, const Key& key, const Body& body) {
  while (first != last) {
    const Crossing* end = first;
    while (end != last && key(*end) == key(*first)) ++end;
    body(first, end);
    first = end;
  }
}

WallSide side_of(const Crossing& x, bool from_below) {
  const bool flip = x.up == from_below;  // seen from below, the normal into the fluid points down
  return {from_below ? x.at : 1 - x.at, flip ? -x.n : x.n, {}, x.face};
}

Index3 line_cell(const Lattice& g, int d, uint64_t line) {
  const int u = d == 0 ? 1 : 0, v = d == 2 ? 1 : 2;
  Index3 c{};
  c[u] = int(line % uint64_t(g.n[u]));
  c[v] = int(line / uint64_t(g.n[u]));
  return c;
}

int winding(const Crossing& x) { return x.thin ? 0 : x.up ? -1 : 1; }

}  // namespace

bool scan(const coupling::WetSurface& surface, const Lattice& lattice, CutMap& map) {
  map.clear(lattice);
  std::vector<Crossing> found[3];
  constexpr size_t chunk = 4096;
  const size_t faces = surface.quads.size(), chunks = (faces + chunk - 1) / chunk;
  std::vector<Crossings> part(chunks);
  parallel_for_dynamic(int64_t(chunks), [&](int64_t i) {
    const size_t first = size_t(i) * chunk;
    part[size_t(i)] = crossings(surface, lattice, first, std::min(first + chunk, faces));
  });
  parallel_for_dynamic(3, [&](int64_t d) {
    found[d] = sorted(part, size_t(d));
  });
  auto line_of = [](const Crossing& x) { return x.line; };
  bool watertight = true;
  for (int d = 0; d < 3; ++d)
    for_each_run(found[d].data(), found[d].data() + found[d].size(), line_of,
                 [&](const Crossing* first, const Crossing* last) {
                   Index3 c = line_cell(lattice, d, first->line);
                   int total = 0;
                   for (const Crossing* x = first; x != last; ++x) total += winding(*x);
                   watertight = watertight && total == 0;
                   for_each_run(
                       first, last, [](const Crossing& x) { return x.i; },
                       [&](const Crossing* a, const Crossing* b) {
                         if (a->i < -1 || a->i >= lattice.n[d]) return;
                         c[d] = a->i;
                         map.add_link(c, d, {side_of(*a, true), side_of(b[-1], false), a->on, b[-1].on});
                       });
                 });
  // all directions agree on a watertight surface; of an open one, each line in metal beyond it covers what it meets
  for (int d = 0; d < 3; ++d) {
    if (d > 0 && watertight) break;
    for_each_run(found[d].data(), found[d].data() + found[d].size(), line_of,
                 [&](const Crossing* first, const Crossing* last) {
                   const Index3 c = line_cell(lattice, d, first->line);
                   int w = 0, least = 0;
                   for (const Crossing* x = first; x != last; ++x) least = std::min(least, w += winding(*x));
                   w = w != 0 ? -least : 0;  // a line that does not come out of the metal it entered started in metal
                   int from = -1;
                   for (const Crossing* x = first; x != last; ++x) {
                     if (w > 0 && x->i >= from) map.cover(c, d, from, x->i);
                     w += winding(*x);
                     from = std::max(-1, x->i + 1);
                   }
                   if (w > 0) map.cover(c, d, from, lattice.n[d]);
                 });
  }
  if (!watertight) map.note_orphans();
  update_velocities(surface, map);
  return watertight;
}

namespace {
/// Nodal values at a crossing; a common value is kept exactly.
Vec3 at_crossing(const coupling::WetSurface& surface, const std::vector<Vec3>& v, int32_t face, const OnFace& on) {
  const auto& q = surface.quads[size_t(face)];
  const bool triangle = q[2] == q[3];
  const Vec3 a = v[q[on.corner]], b = v[q[(on.corner + 1) % 4]];
  const Vec3 c = triangle ? v[q[2]] : 0.25 * ((v[q[0]] + v[q[2]]) + (v[q[1]] + v[q[3]]));
  return a + on.b * (b - a) + on.c * (c - a);
}
/// set(side, value at its crossing) for both sides of all links and apertures; most links have one crossing.
template <class Set>
void for_each_side(const coupling::WetSurface& surface, const std::vector<Vec3>& nodal, CutMap& map, const Set& set) {
  const auto both = [&](CutLink& l) {
    const Vec3 below = at_crossing(surface, nodal, l.below.face, l.below_at);
    set(l.below, below);
    set(l.above, l.above.face == l.below.face && l.above_at == l.below_at
                     ? below
                     : at_crossing(surface, nodal, l.above.face, l.above_at));
  };
  parallel_for(int64_t(map.links().size()), [&](int64_t i) { both(map.links()[size_t(i)]); });
  parallel_for(int64_t(map.apertures().size()), [&](int64_t i) { both(map.apertures()[size_t(i)].link); });
}
}  // namespace

void update_velocities(const coupling::WetSurface& surface, CutMap& map) {
  for_each_side(surface, surface.v, map, [](WallSide& w, const Vec3& v) { w.v = v; });
}

void update_accelerations(const coupling::WetSurface& surface, const std::vector<Vec3>& a, CutMap& map) {
  for_each_side(surface, a, map, [](WallSide& w, const Vec3& at) { w.a_n = float(dot(at, w.n)); });
}

}  // namespace bw::cfd
