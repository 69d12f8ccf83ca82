// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/criteria.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/loop.h"

namespace bw::cfd {

namespace {

void add(Asked& a, int k, int j, int i, int level) {
  const Index3 c{i, j, k};
  for (size_t d = 0; d < 3; ++d) {
    a.lower[d] = a.level < 0 ? c[d] : std::min(a.lower[d], c[d]);
    a.upper[d] = a.level < 0 ? c[d] + 1 : std::max(a.upper[d], c[d] + 1);
  }
  a.level = level;
}
/// What a block wants for itself, and what its cells ask of their surroundings.
struct Wish {
  int level = 0;
  Asks asks;
};

class Criteria {
 public:
  Criteria(const RefineInput& in, const RefineRules& rules)
      : in_(in), rules_(rules), gather_(in.forest, in.state, in.boundary, in.medium) {}

  struct Space {
    Patch patch;
    LevelGhosts ghosts;
  };

  Wish wish(int b, Space& space) const {
    Wish w;
    if (in_.walls) {
      const Index3 first = in_.forest.first_finest(b), n = in_.forest.finest_cells(b);
      Index3 lower = first, upper;
      for (size_t d = 0; d < 3; ++d) {
        const int more = in_.forest.shape().used[d] ? rules_.wall_cells : 0;
        lower[d] -= more, upper[d] = first[d] + n[d] + more;
      }
      if (near_wall(lower, upper)) {
        w.level = in_.forest.levels();
        return w;
      }
      if (in_.walls->map().touches(first, {first[0] + n[0], first[1] + n[1], first[2] + n[2]}) &&
          in_.walls->map().all_blocked(first, {first[0] + n[0], first[1] + n[1], first[2] + n[2]}))
        return w;
    }
    for (const FineRegion& r : rules_.region)
      if (r.level > w.level && reaches(r.shape, b)) w.level = r.level;
    if (burns(b)) w.level = in_.forest.levels();
    if (!rules_.follow_flow) return w;
    if (in_.asks) {
      w.asks = (*in_.asks)[size_t(b)];
    } else if (!gather_.quiet(b)) {
      if (space.patch.pitch() == 0) space.patch = Patch(in_.forest.shape(), in_.medium.count());
      gather_.fill(b, space.patch, space.ghosts);
      w.asks = asks_of(space.patch, in_.medium, rules_, in_.forest.level(b), in_.forest.levels());
    }
    return w;
  }

  /// Does what block `from` asked reach block b?
  int level_from(const Wish& w, int from, int b) const {
    int level = 0;
    for (const Asked* asked : {&w.asks.more, &w.asks.same})
      if (asked->level > level && touches(*asked, from, b)) level = asked->level;
    return level;
  }

 private:
  /// Is there anything but open fluid, or anything but metal, in these cells, around periodic sides too?
  bool near_wall(const Index3& lower, const Index3& upper) const {
    const CutMap& map = in_.walls->map();
    for (int o = 0; o < 27; ++o) {
      const Index3 wrap{o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
      Index3 first, end;
      bool inside = true;
      for (size_t d = 0; d < 3; ++d) {
        const int n = map.lattice().n[d];
        first[d] = std::max(lower[d] + wrap[d] * n, 0), end[d] = std::min(upper[d] + wrap[d] * n, n);
        inside = inside && (wrap[d] == 0 || in_.forest.size().periodic[d]) && first[d] < end[d];
      }
      if (inside && map.touches(first, end) && !map.all_blocked(first, end)) return true;
    }
    return false;
  }
  bool reaches(const RegionShape& shape, int b) const {
    const Vec3 half = 0.5 * in_.forest.extent(b), centre = in_.forest.lower(b) + half;
    double radius = 0;
    for (int d = 0; d < 3; ++d)
      if (in_.forest.shape().used[size_t(d)]) radius += half[d] * half[d];
    return std::visit(
        [&](const auto& s) {
          if constexpr (requires { s.distance(centre); }) return s.distance(centre) < std::sqrt(radius);
          return false;
        },
        shape);
  }
  /// Explosive that is not yet burnt.
  bool burns(int b) const {
    if (!in_.burn || in_.state.t >= in_.burn->t_all || in_.state.info[size_t(b)].material >= 2) return false;
    const Vec3 lower = in_.forest.lower(b);
    const double t = in_.state.t;
    if (in_.burn->phase(lower, lower + in_.forest.extent(b), t, t) == Burn::Phase::after) return false;
    const double* alpha = in_.state.block(b, Cons::alpha1);
    return std::any_of(alpha, alpha + in_.forest.shape().cells(), [](double a) { return a > 1e-3; });
  }
  /// Does the asking box, widened by the buffer, meet block b, around periodic sides too?
  bool touches(const Asked& a, int from, int b) const {
    const Forest& f = in_.forest;
    const Index3 from_first = f.first_finest(from), first = f.first_finest(b), n = f.finest_cells(b),
                 end = f.cells_of_level(f.levels());
    const int scale = 1 << (f.levels() - f.level(from));
    for (size_t d = 0; d < 3; ++d) {
      if (!f.shape().used[d]) continue;
      const int lower = from_first[d] + (a.lower[d] - rules_.buffer) * scale,
                upper = from_first[d] + (a.upper[d] + rules_.buffer) * scale;
      bool meet = false;
      for (int wrap : {0, -end[d], end[d]})
        if (wrap == 0 || f.size().periodic[d])
          meet = meet || (lower + wrap < first[d] + n[d] && upper + wrap > first[d]);
      if (!meet) return false;
    }
    return true;
  }

  const RefineInput& in_;
  const RefineRules& rules_;
  Gather gather_;
};

}  // namespace

Asks asks_of(const Patch& p, const Medium& medium, const RefineRules& rules, int level, int levels) {
  const BlockShape& s = p.shape();
  Asks asks;
  const bool gas = p.material != 0 && medium.is_gas[p.material - 1];
  const int rho1 = gas ? medium.gas[p.material - 1].rho_row : int(Prim::arho1),
            materials = gas ? 1 : std::max(medium.count(), 2);
  int used[3], directions = 0;
  for (int d = 0; d < 3; ++d)
    if (s.used[size_t(d)]) used[directions++] = d;
  const ptrdiff_t step[3] = {1, p.stride_j(), p.stride_k()};
  const double more = rules.refine * rules.refine, same = rules.coarsen * rules.coarsen;
  for (int k = 0; k < s.n[2]; ++k)
    for (int j = 0; j < s.n[1]; ++j)
      for (int i = 0; i < s.n[0]; i += Pack::size) {
        Pack most(0.0);
        for (const int q : {int(Prim::p), rho1}) {
          const double* f = p.row(q, k, j) + i;
          const int parts = q == rho1 ? materials : 1;
          const auto value = [&](ptrdiff_t by) {
            Pack sum = Pack::load(f + by);
            for (int m = 1; m < parts; ++m) sum += Pack::load(p.row(Prim::arho(m), k, j) + i + by);
            return sum;
          };
          Pack below[3], above[3];
          for (int e = 0; e < directions; ++e) below[e] = value(-step[used[e]]), above[e] = value(step[used[e]]);
          most = max(most, refine_indicator(directions, below, value(0), above));
        }
        if (!any(most > Pack(same))) continue;
        for (int l = 0; l < std::min(Pack::size, s.n[0] - i); ++l) {
          if (most[l] > more) add(asks.more, k, j, i + l, std::min(level + 1, levels));
          if (most[l] > same) add(asks.same, k, j, i + l, level);
        }
      }
  return asks;
}

std::vector<int8_t> refine_wishes(const RefineInput& in, const RefineRules& rules) {
  const Forest& forest = in.forest;
  const Criteria criteria(in, rules);
  std::vector<Wish> wishes(size_t(forest.local_blocks() + forest.ghost_blocks()));
  std::vector<Criteria::Space> spaces{size_t(thread_count())};
  parallel_for_dynamic(forest.local_blocks(), spaces,
                       [&](int64_t b, Criteria::Space& space) { wishes[size_t(b)] = criteria.wish(int(b), space); });
  forest.exchange(
      sizeof(Wish), [&](int b) { return &wishes[size_t(b)]; }, wishes.data() + forest.local_blocks());
  std::vector<int8_t> result(size_t(forest.local_blocks()), 0);
  for (int b = 0; b < forest.local_blocks(); ++b) {
    const Wish& own = wishes[size_t(b)];
    int level = std::max({own.level, own.asks.more.level, own.asks.same.level});
    for (int a : forest.around(b)) level = std::max(level, criteria.level_from(wishes[size_t(a)], a, b));
    level = std::min(level, forest.levels());
    result[size_t(b)] = int8_t(level > forest.level(b) ? 1 : level < forest.level(b) ? -1 : 0);
  }
  return result;
}

}  // namespace bw::cfd
