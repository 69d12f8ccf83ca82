// SPDX-License-Identifier: Apache-2.0
// What the walls do to one lattice of cells: which centres lie in metal, and which links between neighbouring centres
// are cut, where, by which face. Kept in small tiles that exist only near the surface, so memory and time go with its
// area.
#pragma once
#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cfd/embed/lattice.h"

namespace bw::cfd {

/// Bits of a cell. A blocked cell holds no fluid.
enum CellFlag : uint8_t {
  cell_covered = 1,  ///< its centre is inside a closed body
  cell_sealed = 2,   ///< open, but never connected to any fluid since it was uncovered
  cell_fresh = 4,    ///< uncovered or swept by the last motion: to be refilled
  cell_cut = 8,      ///< (cell_cut << d): the link to the upper neighbour in direction d is cut
  cell_blocked = cell_covered | cell_sealed,
};

/// The wall as one cell sees it along a grid line.
struct WallSide {
  double s = 0.5;     ///< distance centre -> crossing in cell sizes, in [0, 1]
  Vec3 n;             ///< unit normal of the face, into the fluid of this cell
  Vec3 v;             ///< velocity of the wall at the crossing [m/s]
  int32_t face = -1;  ///< index into WetSurface::quads, -1: none (an open surface ends here)
  float a_n = 0;      ///< acceleration of the wall along n [m/s^2], where the treatment asks for it
};
/// Where on its face a crossing is: triangle `corner` of the face's fan (cfd/embed/scan.h), x = (1 - b - c) a + b b + c
/// c.
struct OnFace {
  int32_t corner = 0;
  double b = 0, c = 0;
  friend bool operator==(const OnFace&, const OnFace&) = default;
};
/// A cut link between a cell and its upper neighbour: the crossing next to either.
struct CutLink {
  WallSide below, above;
  OnFace below_at, above_at;
};

/// A link between two open cells whose cell face a wall blocks in part (cfd/embed/apertures.h).
struct Aperture {
  Index3 cell{};  ///< the link leads to its upper neighbour
  int d = 0;
  double open = 0;  ///< part of the cell face, in [0, 1)
  CutLink link;     ///< of the rest
};

class CutMap {
 public:
  static constexpr int edge = 8;  ///< cells per tile edge
  static constexpr int cells = edge * edge * edge;

  /// Everything open. Cells -1 .. n of each direction exist (a link may lead out of the lattice).
  void clear(const Lattice& lattice);

  const Lattice& lattice() const { return lattice_; }
  uint8_t flags(const Index3& c) const {
    const int32_t t = tile_[tile_of(c)];
    return t == open_tile ? 0 : t == covered_tile ? uint8_t(cell_covered) : flags_[size_t(t) * cells + place(c)];
  }
  /// Where index i of direction d is kept: a cell's place is the sum over its directions. For loops over many cells.
  struct Place {
    size_t tile = 0, cell = 0;
  };
  Place place_along(int d, int i) const {
    Index3 c{-1, -1, -1};
    c[size_t(d)] = i;
    return {tile_of(c), place(c)};
  }
  bool all_open(size_t tile) const { return tile_[tile] == open_tile; }
  /// Flags of cells i0 <= i < i1 of the row with these places along y and z. Are any set?
  bool copy_flags(const Place& y, const Place& z, int i0, int i1, uint8_t* out) const;
  /// Are cells [first, first + n) blocked? [k][j][i], 1 or 0. Is any?
  bool copy_blocked(const Index3& first, const Index3& n, uint8_t* out) const;
  /// May a cell in metal border on an open one without a cut link? (Open surfaces, sealed cells.)
  bool may_have_orphans() const { return may_have_orphans_; }
  bool blocked(const Index3& c) const { return flags(c) & cell_blocked; }
  bool is_cut(const Index3& c, int d) const { return flags(c) & (cell_cut << d); }
  /// The link from c to c + e_d; nullptr if it is not cut.
  const CutLink* link(const Index3& c, int d) const {
    const int32_t t = tile_[tile_of(c)];
    if (t < 0) return nullptr;
    const size_t i = size_t(t) * cells + place(c);
    return flags_[i] & (cell_cut << d) ? &links_[size_t(link_[d][i])] : nullptr;
  }
  /// May anything in cells [lower, upper) differ from open fluid? Is all of it in metal?
  bool touches(Index3 lower, Index3 upper) const;
  bool all_blocked(const Index3& lower, const Index3& upper) const;
  /// Is a cell in [lower, upper) in metal or a link of one cut? Looks at each where touches().
  bool holds_any(const Index3& lower, const Index3& upper) const;
  size_t link_count() const { return links_.size(); }
  const std::vector<Aperture>& apertures() const { return apertures_; }
  std::vector<Aperture>& apertures() { return apertures_; }
  /// visit(aperture) for those in the tiles of cells [lower, upper).
  template <class Visit>
  void for_each_aperture(Index3 lower, Index3 upper, const Visit& visit) const {
    if (apertures_.empty()) return;
    for (size_t d = 0; d < 3; ++d) {
      lower[d] = std::clamp(lower[d], -1, lattice_.n[d]);
      upper[d] = std::clamp(upper[d], lower[d] + 1, lattice_.n[d] + 1);
    }
    const auto tile = [](int i) { return (i + 1) / edge; };
    for (int k = tile(lower[2]); k <= tile(upper[2] - 1); ++k)
      for (int j = tile(lower[1]); j <= tile(upper[1] - 1); ++j)
        for (int i = tile(lower[0]); i <= tile(upper[0] - 1); ++i)
          if (const auto it = apertures_of_.find((size_t(k) * tiles_[1] + size_t(j)) * tiles_[0] + size_t(i));
              it != apertures_of_.end())
            for (const int32_t a : it->second) visit(apertures_[size_t(a)]);
  }

  // --- building (scan.cpp, motion.cpp)
  void note_orphans() { may_have_orphans_ = true; }
  std::vector<CutLink>& links() { return links_; }
  void add_link(const Index3& c, int d, const CutLink& link);
  void add_aperture(const Aperture& a);
  /// Cells [first, last] of the line through c in direction d are in metal. Call after all links were added.
  void cover(Index3 c, int d, int first, int last);
  void set_flag(const Index3& c, uint8_t flag) { flags_[make_tile(c) * cells + place(c)] |= flag; }
  void drop_flag(const Index3& c, uint8_t flag) { flags_[make_tile(c) * cells + place(c)] &= uint8_t(~flag); }
  /// visit(Index3 cell) for the cells of the lattice that may differ between two maps of one lattice.
  template <class Visit>
  static void for_each_difference(const CutMap& a, const CutMap& b, const Visit& visit) {
    for (size_t t = 0; t < a.tile_.size(); ++t) {
      if (a.tile_[t] == b.tile_[t] && a.tile_[t] < 0) continue;
      const Index3 o = a.origin(t);
      for (int k = 0; k < edge; ++k)
        for (int j = 0; j < edge; ++j)
          for (int i = 0; i < edge; ++i) {
            const Index3 c{o[0] + i, o[1] + j, o[2] + k};
            if (a.inside(c)) visit(c);
          }
    }
  }
  bool inside(const Index3& c) const {
    for (int d = 0; d < 3; ++d)
      if (c[d] < 0 || c[d] >= lattice_.n[d]) return false;
    return true;
  }

 private:
  static constexpr int32_t open_tile = -1, covered_tile = -2;
  // tiles are shifted by one cell, so that cell -1 is in the first
  size_t tile_of(const Index3& c) const {
    return (size_t((c[2] + 1) / edge) * tiles_[1] + size_t((c[1] + 1) / edge)) * tiles_[0] + size_t((c[0] + 1) / edge);
  }
  static size_t place(const Index3& c) {
    return (size_t((c[2] + 1) % edge) * edge + size_t((c[1] + 1) % edge)) * edge + size_t((c[0] + 1) % edge);
  }
  Index3 origin(size_t t) const {
    const size_t x = t % tiles_[0], y = t / tiles_[0] % tiles_[1], z = t / (tiles_[0] * tiles_[1]);
    return {int(x) * edge - 1, int(y) * edge - 1, int(z) * edge - 1};
  }
  size_t make_tile(const Index3& c);

  Lattice lattice_;
  size_t tiles_[3] = {0, 0, 0};
  std::vector<int32_t> tile_;     ///< [tile] open_tile, covered_tile, or the place of its cells below
  std::vector<uint8_t> flags_;    ///< [made tile][cell]
  std::vector<int32_t> link_[3];  ///< [made tile][cell] into links_; valid where the flag is set
  std::vector<CutLink> links_;
  std::vector<Aperture> apertures_;
  std::unordered_map<size_t, std::vector<int32_t>> apertures_of_;  ///< by tile
  bool may_have_orphans_ = false;
};

}  // namespace bw::cfd
