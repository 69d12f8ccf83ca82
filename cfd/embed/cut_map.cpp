// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/cut_map.h"

#include <algorithm>
#include <cstring>

namespace bw::cfd {

void CutMap::clear(const Lattice& lattice) {
  lattice_ = lattice;
  for (int d = 0; d < 3; ++d) tiles_[d] = size_t((lattice.n[d] + 2 + edge - 1) / edge);
  tile_.assign(tiles_[0] * tiles_[1] * tiles_[2], open_tile);
  flags_.clear();
  for (auto& l : link_) l.clear();
  links_.clear();
  apertures_.clear();
  apertures_of_.clear();
  may_have_orphans_ = false;
}

size_t CutMap::make_tile(const Index3& c) {
  int32_t& t = tile_[tile_of(c)];
  if (t >= 0) return size_t(t);
  const uint8_t fill = t == covered_tile ? uint8_t(cell_covered) : uint8_t(0);
  t = int32_t(flags_.size() / cells);
  flags_.resize(flags_.size() + cells, fill);
  for (auto& l : link_) l.resize(flags_.size());
  return size_t(t);
}

void CutMap::add_link(const Index3& c, int d, const CutLink& link) {
  const size_t i = make_tile(c) * cells + place(c);
  flags_[i] |= uint8_t(cell_cut << d);
  link_[d][i] = int32_t(links_.size());
  links_.push_back(link);
  Index3 upper = c;
  ++upper[d];
  make_tile(upper);  // a tile without links is all open or all covered: cover() relies on it
}

void CutMap::add_aperture(const Aperture& a) {
  make_tile(a.cell);  // a tile that is made is looked at
  Index3 upper = a.cell;
  ++upper[size_t(a.d)];
  make_tile(upper);
  apertures_of_[tile_of(a.cell)].push_back(int32_t(apertures_.size()));
  apertures_.push_back(a);
}

void CutMap::cover(Index3 c, int d, int first, int last) {
  first = std::max(first, -1);
  last = std::min(last, lattice_.n[d]);
  for (int i = first; i <= last;) {
    c[d] = i;
    const int end = std::min(last + 1, ((i + 1) / edge + 1) * edge - 1);  // first cell of the next tile
    int32_t& t = tile_[tile_of(c)];
    if (t < 0) {
      t = covered_tile;
    } else {
      for (; i < end; ++i) {
        c[d] = i;
        flags_[size_t(t) * cells + place(c)] |= cell_covered;
      }
    }
    i = end;
  }
}

bool CutMap::copy_flags(const Place& y, const Place& z, int i0, int i1, uint8_t* out) const {
  bool any = false;
  for (int i = i0; i < i1;) {
    const int end = std::min(i1, ((i + 1) / edge + 1) * edge - 1);  // first cell of the next tile
    const Place x = place_along(0, i);
    const int32_t t = tile_[x.tile + y.tile + z.tile];
    if (t < 0)
      std::memset(out + (i - i0), t == covered_tile ? cell_covered : 0, size_t(end - i));
    else
      std::memcpy(out + (i - i0), &flags_[size_t(t) * cells + x.cell + y.cell + z.cell], size_t(end - i));
    any = any || t != open_tile;
    i = end;
  }
  return any;
}

bool CutMap::copy_blocked(const Index3& first, const Index3& n, uint8_t* out) const {
  const int n0 = n[0];
  uint8_t any = 0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j, out += n0) {
      if (!copy_flags(place_along(1, first[1] + j), place_along(2, first[2] + k), first[0], first[0] + n0, out)) continue;
      for (int i = 0; i < n0; ++i) any = uint8_t(any | (out[i] = uint8_t((out[i] & cell_blocked) != 0)));
    }
  return any;
}

bool CutMap::touches(Index3 lower, Index3 upper) const {
  for (int d = 0; d < 3; ++d) {
    lower[d] = std::max(lower[d], -1);
    upper[d] = std::min(upper[d], lattice_.n[d] + 1);
  }
  auto next = [](int i) { return (i + 1) / edge * edge + edge - 1; };  // first cell of the next tile
  Index3 c;
  for (c[2] = lower[2]; c[2] < upper[2]; c[2] = next(c[2]))
    for (c[1] = lower[1]; c[1] < upper[1]; c[1] = next(c[1]))
      for (c[0] = lower[0]; c[0] < upper[0]; c[0] = next(c[0]))
        if (tile_[tile_of(c)] != open_tile) return true;
  return false;
}

bool CutMap::holds_any(const Index3& lower, const Index3& upper) const {
  if (!touches(lower, upper)) return false;
  Index3 c;
  for (c[2] = lower[2]; c[2] < upper[2]; ++c[2])
    for (c[1] = lower[1]; c[1] < upper[1]; ++c[1])
      for (c[0] = lower[0]; c[0] < upper[0]; ++c[0])
        if (flags(c) != 0) return true;
  return false;
}

bool CutMap::all_blocked(const Index3& lower, const Index3& upper) const {
  Index3 c;
  for (c[2] = lower[2]; c[2] < upper[2]; ++c[2])
    for (c[1] = lower[1]; c[1] < upper[1]; ++c[1])
      for (c[0] = lower[0]; c[0] < upper[0]; ++c[0])
        if (!blocked(c)) return false;
  return true;
}

}  // namespace bw::cfd
