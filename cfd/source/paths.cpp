// SPDX-License-Identifier: Apache-2.0
#include "cfd/source/paths.h"

#include <cmath>
#include <queue>

namespace bw::cfd {
namespace {

constexpr double none = 1e300;
constexpr int lit = -1;  ///< parent: where the burn began

class Search {
 public:
  Search(const Burn& burn, const ExplosiveCells& cells)
      : burn_(burn),
        c_(cells),
        way_(cells.inside.size(), none),
        parent_(cells.inside.size(), lit),
        done_(cells.inside.size(), 0) {}

  /// Through the explosive from where it is lit, then through all other cells from it. False: straight lines do.
  bool run(int64_t& unreached) {
    bool all_lit = true;
    for (size_t a = 0; a < way_.size(); ++a) {
      if (!c_.inside[a]) continue;
      if (sees_light(int(a)))
        open(int(a), burn_.straight(centre(int(a))), lit);
      else
        all_lit = false;
    }
    unreached = 0;
    if (all_lit) return false;
    drain(true);
    for (size_t a = 0; a < way_.size(); ++a) unreached += c_.inside[a] && way_[a] == none;
    for (size_t a = 0; a < way_.size(); ++a)
      if (done_[a]) spread(int(a), false);
    drain(false);
    return true;
  }
  double way(size_t a) const { return way_[a]; }
  Vec3 centre(int a) const {
    const int i = a % c_.n[0], j = a / c_.n[0] % c_.n[1], k = a / (c_.n[0] * c_.n[1]);
    return c_.lower + Vec3{i * c_.h.x, j * c_.h.y, k * c_.h.z};
  }

 private:
  struct Entry {
    double way;
    int cell;
    bool operator<(const Entry& o) const { return way > o.way || (way == o.way && cell > o.cell); }
  };

  int cell_of(const Vec3& x) const {
    int i[3];
    for (int d = 0; d < 3; ++d)
      i[d] = std::clamp(int(std::lround((x[d] - c_.lower[d]) / c_.h[d])), 0, c_.n[size_t(d)] - 1);
    return (i[2] * c_.n[1] + i[1]) * c_.n[0] + i[0];
  }
  /// Does the straight line stay in the explosive?
  bool free(const Vec3& a, const Vec3& b) const {
    double cells = 0;
    for (int d = 0; d < 3; ++d)
      if (c_.n[size_t(d)] > 1) cells = std::max(cells, std::abs(b[d] - a[d]) / c_.h[d]);
    const int steps = 2 * int(std::ceil(cells));
    for (int i = 1; i < steps; ++i)
      if (!c_.inside[size_t(cell_of(a + (double(i) / steps) * (b - a)))]) return false;
    return true;
  }
  bool sees_light(int a) const {
    const Vec3 x = centre(a);
    const double least = burn_.straight(x) * (1 + 1e-9);
    const auto reached = [&](const Vec3& from) { return norm(x - from) <= least && free(from, x); };
    for (const Vec3& p : burn_.points)
      if (reached(p)) return true;
    for (const LineLight& l : burn_.lines)
      if (reached(l.nearest(x))) return true;
    for (const DiscLight& d : burn_.discs)
      if (reached(d.nearest(x))) return true;
    return false;
  }
  void open(int a, double way, int parent) {
    if (way >= way_[size_t(a)]) return;
    way_[size_t(a)] = way, parent_[size_t(a)] = parent;
    queue_.push({way, a});
  }
  template <class Visit>
  void around(int a, const Visit& visit) const {
    const int i = a % c_.n[0], j = a / c_.n[0] % c_.n[1], k = a / (c_.n[0] * c_.n[1]);
    for (int o = 0; o < 27; ++o) {
      const int x = i + o % 3 - 1, y = j + o / 3 % 3 - 1, z = k + o / 9 - 1;
      if (o != 13 && x >= 0 && x < c_.n[0] && y >= 0 && y < c_.n[1] && z >= 0 && z < c_.n[2])
        visit((z * c_.n[1] + y) * c_.n[0] + x);
    }
  }
  double step(int a, int b) const { return norm(centre(a) - centre(b)); }
  /// The last corner of the way to a: a itself if the way is straight from the light.
  int corner(int a) const { return parent_[size_t(a)] == lit ? a : parent_[size_t(a)]; }
  void spread(int a, bool in_explosive) {
    around(a, [&](int b) {
      if (done_[size_t(b)] || bool(c_.inside[size_t(b)]) != in_explosive) return;
      const int from = in_explosive ? corner(a) : a;
      open(b, way_[size_t(from)] + step(from, b), from);
    });
  }
  void drain(bool in_explosive) {
    while (!queue_.empty()) {
      const Entry e = queue_.top();
      queue_.pop();
      const size_t a = size_t(e.cell);
      if (done_[a] || e.way > way_[a]) continue;
      if (in_explosive && parent_[a] != lit && !free(centre(parent_[a]), centre(e.cell))) {
        // the corner is out of sight: the way goes by the best neighbour that is done
        double best = none;
        int by = lit;
        around(e.cell, [&](int b) {
          if (!done_[size_t(b)] || !c_.inside[size_t(b)]) return;
          if (const double way = way_[size_t(b)] + step(b, e.cell); way < best) best = way, by = b;
        });
        way_[a] = best, parent_[a] = by;
        if (!queue_.empty() && best > queue_.top().way) {
          queue_.push({best, e.cell});
          continue;
        }
      }
      done_[a] = 1;
      spread(e.cell, in_explosive);
    }
  }

  const Burn& burn_;
  const ExplosiveCells& c_;
  std::vector<double> way_;
  std::vector<int> parent_;
  std::vector<uint8_t> done_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

WayTable find_ways(const Burn& burn, const ExplosiveCells& cells, int64_t& unreached) {
  Search search(burn, cells);
  if (!search.run(unreached)) return {};
  double h = 0;
  for (int d = 0; d < 3; ++d)
    if (cells.n[size_t(d)] > 1) h = std::max(h, cells.h[d]);
  WayTable table{cells.lower, cells.h, cells.n, std::vector<double>(cells.inside.size(), 0.0)};
  for (size_t a = 0; a < cells.inside.size(); ++a) {
    const double longer = search.way(a) == none ? 0 : search.way(a) - burn.straight(search.centre(int(a)));
    table.longer[a] = std::max(longer, 0.0);
    if (cells.inside[a]) table.most = std::max(table.most, longer);
  }
  if (table.most < h) return {};  // steps of the surface, not a corner
  for (double longer : table.longer) table.most = std::max(table.most, longer);
  return table;
}

}  // namespace bw::cfd
