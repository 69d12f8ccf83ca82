// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/patch_cuts.h"

#include <algorithm>
#include <cstdint>

namespace bw::cfd {

PatchCuts::PatchCuts(const BlockShape& shape) : shape_(shape) {
  for (int d = 0; d < 3; ++d) {
    g_[d] = shape.ghost(d);
    e_[d] = shape.n[size_t(d)] + 2 * g_[d];
    source_[d].resize(size_t(e_[d]));
  }
  step_[0] = 1, step_[1] = e_[0], step_[2] = e_[0] * e_[1];
  bits_.resize(size_t(size()));
  raw_.resize(size_t(size()));
  touched_.resize(size_t(size()));
  written_.resize(size_t(e_[1] * e_[2]));
  for (auto& w : wall_) w.resize(size_t(size()));
}

void PatchCuts::set_wall(int c, uint16_t bit, int d, int side, const WallSide& w, double open) {
  bits_[size_t(c)] |= uint16_t(bit << (2 * d + side));
  touched_[size_t(c)] = 1;
  written_[size_t(c / e_[0])] = 1;
  wall_[2 * d + side][size_t(c)] = int32_t(walls_.size());
  walls_.push_back(&w);
  open_.push_back(open);
}

/// Apertures between cells of the lattice; those in ghosts beyond its sides matter to no flux.
void PatchCuts::gather_apertures(const CutMap& map, const Index3& lower, const Index3& upper) {
  map.for_each_aperture(lower, upper, [&](const Aperture& a) {
    Index3 c;
    for (size_t e = 0; e < 3; ++e) {
      c[e] = a.cell[e] - origin_[e];
      if (a.cell[e] < lower[e] || a.cell[e] + (int(e) == a.d) >= upper[e]) return;
    }
    const int low = at(c[2], c[1], c[0]), high = low + step_[a.d];
    if (blocked(low) || blocked(high)) return;
    set_wall(low, first_narrow, a.d, 1, a.link.below, a.open);
    set_wall(high, first_narrow, a.d, 0, a.link.above, a.open);
  });
}

/// The link between patch cell c (number `at`) and its upper neighbour in direction d.
void PatchCuts::gather_links(const CutMap& map, int d, const Index3& c, int at) {
  const int n = map.lattice().n[size_t(d)];
  Index3 from;
  bool reflected[3];
  for (int e = 0; e < 3; ++e) {
    const Source& s = source_[e][size_t(c[size_t(e)] + g_[e])];
    from[size_t(e)] = s.index;
    reflected[e] = s.reflected;
  }
  const int low = origin_[size_t(d)] + c[size_t(d)];  // of the link's lower cell, not wrapped
  const CutLink* link = nullptr;
  bool swap = false;
  if (low >= -1 && low < n) {  // a link of the lattice, or through its boundary
    from[size_t(d)] = low;
    reflected[d] = false;
    link = map.link(from, d);
    const bool through = low == -1 || low == n - 1;
    if (!link && through && rules_[size_t(2 * d + (low == -1 ? 0 : 1))] == GhostRule::periodic) {
      from[size_t(d)] = low == -1 ? n - 1 : -1;
      link = map.link(from, d);
    }
  } else {
    const GhostRule rule = rules_[size_t(2 * d + (low < 0 ? 0 : 1))];
    if (rule == GhostRule::copy) return;
    const Source& upper = source_[d][size_t(c[size_t(d)] + 1 + g_[d])];
    swap = rule == GhostRule::mirror;
    from[size_t(d)] = swap ? upper.index : source_[d][size_t(c[size_t(d)] + g_[d])].index;
    reflected[d] = swap;
    link = map.link(from, d);
  }
  if (!link) return;
  const auto seen = [&](const WallSide& w) -> const WallSide& {
    if (!reflected[0] && !reflected[1] && !reflected[2]) return w;
    WallSide& image = own_.emplace_back(w);
    for (int e = 0; e < 3; ++e)
      if (reflected[e]) image.n[e] = -image.n[e], image.v[e] = -image.v[e];
    return image;
  };
  set_wall(at, first_cut, d, 1, seen(swap ? link->above : link->below));
  set_wall(at + step_[d], first_cut, d, 0, seen(swap ? link->below : link->above));
}

/// No face between metal and fluid: an open surface ends here, or a cell is sealed. A resting wall half way.
void PatchCuts::close_orphans(int d) {
  const int n_row = e_[0] - (d == 0), end[2] = {e_[1] - (d == 1), e_[2] - (d == 2)};
  for (int k = 0; k < end[1]; ++k)
    for (int j = 0; j < end[0]; ++j) {
      const int first = (k * e_[1] + j) * e_[0], above = first + step_[d];
      if (!written_[size_t(first / e_[0])] && !written_[size_t(above / e_[0])]) continue;
      const uint16_t *a = &bits_[size_t(first)], *b = &bits_[size_t(above)];
      uint16_t differ = 0;
      for (int i = 0; i < n_row; ++i) differ = uint16_t(differ | ((a[i] ^ b[i]) & is_blocked));
      if (!differ) continue;
      for (int i = 0; i < n_row; ++i) {
        const int c = first + i;
        if (blocked(c) == blocked(c + step_[d]) || cut(c, d, 1)) continue;
        Vec3 n;
        n[d] = blocked(c) ? 1 : -1;
        const WallSide& w = own_.emplace_back(WallSide{0.5, n, {}, -1});
        set_wall(c, first_cut, d, 1, w);
        set_wall(c + step_[d], first_cut, d, 0, w);
      }
    }
}

void PatchCuts::gather(const CutMap& map, const GhostRules& rules, const Index3& origin) {
  rules_ = rules;
  origin_ = origin;
  walls_.clear();
  own_.clear();
  open_.clear();
  Index3 lower = origin, upper;
  for (size_t d = 0; d < 3; ++d) {
    const int n = map.lattice().n[d];
    for (int i = -g_[d]; i < e_[d] - g_[d]; ++i) {
      Source& s = source_[d][size_t(i + g_[d])];
      s = {origin[d] + i, false};
      if (s.index >= 0 && s.index < n) continue;
      const bool up = s.index >= n;
      switch (rules[2 * d + size_t(up)]) {
        case GhostRule::mirror:
          s = {up ? 2 * n - 1 - s.index : -1 - s.index, true};
          break;
        case GhostRule::copy:
          s.index = up ? n - 1 : 0;
          break;
        case GhostRule::periodic:
          s.index += up ? -n : n;
          break;
      }
    }
    lower[d] -= g_[d];
    upper[d] = lower[d] + e_[d];
  }
  any_ = map.touches(lower, upper);
  for (size_t d = 0; d < 3; ++d)  // ghosts from the other end of a periodic domain
    if (g_[d] > 0 && (rules[2 * d] == GhostRule::periodic))
      any_ = any_ || lower[d] < 0 || upper[d] > map.lattice().n[d];
  if (!any_) return;

  read_flags(map);
  for (size_t d = 0; d < 3; ++d) {
    if (!shape_.used[d]) continue;
    const int n = map.lattice().n[d], end = e_[d] - g_[d] - 1;
    auto within = [&](int i) { return origin[d] + i >= 0 && origin[d] + i < n - 1; };
    for (const Index3& c : cut_cells_) {
      const int at_c = at(c[2], c[1], c[0]);
      if (c[d] < end && within(c[d]) && raw_[size_t(at_c)] & (cell_cut << d)) gather_links(map, int(d), c, at_c);
    }
    bool at_side = false;
    for (int i = -g_[d]; i < end; ++i) {
      if (within(i) || !meets_walls(map, int(d), i)) continue;
      at_side = true;
      Index3 c, low{-g_[0], -g_[1], -g_[2]}, high{e_[0] - g_[0], e_[1] - g_[1], e_[2] - g_[2]};
      low[d] = i, high[d] = i + 1;
      for (c[2] = low[2]; c[2] < high[2]; ++c[2])
        for (c[1] = low[1]; c[1] < high[1]; ++c[1])
          for (c[0] = low[0]; c[0] < high[0]; ++c[0]) gather_links(map, int(d), c, at(c[2], c[1], c[0]));
    }
    if (at_side || map.may_have_orphans()) close_orphans(int(d));
  }
  gather_apertures(map, lower, upper);
}

/// Flags of the cells that the patch's cells stand for: raw_, bits_ and touched_ of blocked ones, cut_cells_.
void PatchCuts::read_flags(const CutMap& map) {
  cut_cells_.clear();
  const int n = map.lattice().n[0], n_row = e_[0], first = std::clamp(g_[0] - origin_[0], 0, n_row),
            last = std::clamp(n + g_[0] - origin_[0], first, n_row);  // patch cells along x that are the lattice's own
  std::vector<size_t> tiles;  // along x
  for (const Source& s : source_[0])
    if (const size_t t = map.place_along(0, s.index).tile; tiles.empty() || tiles.back() != t) tiles.push_back(t);
  size_t looked_at = SIZE_MAX;
  bool open = false;
  for (int k = 0; k < e_[2]; ++k)
    for (int j = 0; j < e_[1]; ++j) {
      const CutMap::Place y = map.place_along(1, source_[1][size_t(j)].index), z = map.place_along(2, source_[2][size_t(k)].index);
      if (y.tile + z.tile != looked_at) {
        looked_at = y.tile + z.tile;
        open = std::all_of(tiles.begin(), tiles.end(), [&](size_t x) { return map.all_open(x + looked_at); });
      }
      const size_t row = size_t(k * e_[1] + j), at = row * size_t(n_row);
      if (open && !written_[row]) continue;
      written_[row] = !open;
      uint8_t *raw = &raw_[at], *touched = &touched_[at];
      uint16_t* bits = &bits_[at];
      if (open) {
        std::fill_n(raw, n_row, uint8_t(0)), std::fill_n(touched, n_row, uint8_t(0)), std::fill_n(bits, n_row, uint16_t(0));
        continue;
      }
      map.copy_flags(y, z, origin_[0] + first - g_[0], origin_[0] + last - g_[0], raw + first);
      for (int i = 0; i < n_row; ++i)
        if (const int from = source_[0][size_t(i)].index; i < first || i >= last) map.copy_flags(y, z, from, from + 1, raw + i);
      for (int i = 0; i < n_row; ++i) touched[i] = (raw[i] & cell_blocked) != 0;
      for (int i = 0; i < n_row; ++i) bits[i] = uint16_t(touched[i] * is_blocked);
      for (int i = 0; i < n_row; ++i)
        if (raw[i] >= cell_cut) cut_cells_.push_back({i - g_[0], j - g_[1], k - g_[2]});
    }
}

/// May anything but open fluid be among what links between layers i and i + 1 along d stand for?
bool PatchCuts::meets_walls(const CutMap& map, int d, int i) const {
  Index3 lower, upper;
  for (int e = 0; e < 3; ++e) {
    const size_t first = size_t(e == d ? i + g_[e] : 0), last = e == d ? first + 1 : source_[e].size() - 1;
    lower[size_t(e)] = map.lattice().n[size_t(e)], upper[size_t(e)] = 0;
    for (size_t at = first; at <= last; ++at) {
      lower[size_t(e)] = std::min(lower[size_t(e)], source_[e][at].index);
      upper[size_t(e)] = std::max(upper[size_t(e)], source_[e][at].index + 1);
    }
  }
  --lower[size_t(d)], ++upper[size_t(d)];  // links through the lattice's sides
  return map.touches(lower, upper);
}

bool PatchCuts::copy_blocked(uint8_t* out) const {
  const int n = shape_.n[0];
  uint8_t any = 0;
  for (int k = 0; k < shape_.n[2]; ++k)
    for (int j = 0; j < shape_.n[1]; ++j, out += n) {
      const uint16_t* bits = &bits_[size_t(at(k, j, 0))];
      for (int i = 0; i < n; ++i) any = uint8_t(any | (out[i] = uint8_t(bits[i] / is_blocked & 1)));
    }
  return any;
}

}  // namespace bw::cfd
