// SPDX-License-Identifier: Apache-2.0
// The walls in one patch (a block and its ghosts), looked up once for all kernels of a step.
#pragma once
#include <array>
#include <deque>
#include <vector>

#include "cfd/amr/patch.h"
#include "cfd/embed/cut_map.h"

namespace bw::cfd {

/// How the ghosts beyond a side of the domain are made, so that the walls in them match.
enum class GhostRule { mirror, copy, periodic };
using GhostRules = std::array<GhostRule, 6>;  ///< [2 d + upper]

class PatchCuts {
 public:
  PatchCuts() = default;
  explicit PatchCuts(const BlockShape& shape);

  /// origin: lattice cell of the block's first cell.
  void gather(const CutMap& map, const GhostRules& rules, const Index3& origin);

  /// Patch cells as one number; step(d) leads to the upper neighbour.
  int at(int k, int j, int i) const { return ((k + g_[2]) * e_[1] + (j + g_[1])) * e_[0] + (i + g_[0]); }
  int step(int d) const { return step_[d]; }
  int size() const { return e_[0] * e_[1] * e_[2]; }
  bool blocked(int c) const { return bits_[size_t(c)] & is_blocked; }
  /// Is the link of the open cell c on this side (0 lower, 1 upper) cut? Every link to a blocked neighbour is.
  bool cut(int c, int d, int side) const { return bits_[size_t(c)] & (1u << (2 * d + side)); }
  /// Bits 2d + side of the cut ones.
  unsigned cut_sides(int c) const { return bits_[size_t(c)] & (is_blocked - 1); }
  /// Is a part of the cell face of this link open, a part blocked by a wall? The link itself may be cut or not.
  bool narrow(int c, int d, int side) const { return bits_[size_t(c)] & (first_narrow << (2 * d + side)); }
  /// That part, where narrow().
  double open(int c, int d, int side) const { return open_[size_t(wall_[2 * d + side][size_t(c)])]; }
  bool touched(int c) const { return touched_[size_t(c)]; }
  const uint8_t* touched() const { return touched_.data(); }  ///< [size()]
  /// Until the map that it was gathered from changes.
  const WallSide& wall(int c, int d, int side) const { return *walls_[size_t(wall_[2 * d + side][size_t(c)])]; }
  bool any() const { return any_; }  ///< anything but open fluid?
  /// Is a cell of the block itself blocked? [k][j][i], 1 or 0. Is any?
  bool copy_blocked(uint8_t* out) const;
  const BlockShape& shape() const { return shape_; }

 private:
  static constexpr uint16_t first_cut = 1, is_blocked = 64, first_narrow = 128;
  /// bit: first_cut or first_narrow; open: see open().
  void set_wall(int c, uint16_t bit, int d, int side, const WallSide& w, double open = 0);
  void close_orphans(int d);
  void read_flags(const CutMap& map);
  bool meets_walls(const CutMap& map, int d, int i) const;
  void gather_apertures(const CutMap& map, const Index3& lower, const Index3& upper);
  void gather_links(const CutMap& map, int d, const Index3& c, int at);

  /// One lattice index seen from the patch.
  struct Source {
    int index = 0;
    bool reflected = false;
  };
  BlockShape shape_;
  int g_[3] = {}, e_[3] = {}, step_[3] = {};
  std::vector<Source> source_[3];  ///< by patch index + ghosts
  GhostRules rules_{};
  Index3 origin_{};
  std::vector<uint16_t> bits_;
  std::vector<uint8_t> raw_;       ///< CellFlag bits of the source cells
  std::vector<uint8_t> touched_;   ///< any bit
  std::vector<uint8_t> written_;   ///< by row along x: raw_, touched_ or bits_ are not all 0
  std::vector<Index3> cut_cells_;  ///< with a cut link to an upper neighbour
  std::vector<int32_t> wall_[6];   ///< into walls_, valid where the bit is set
  std::vector<const WallSide*> walls_;  ///< of the map, or:
  std::deque<WallSide> own_;            ///< reflected ones, and those that no face makes
  std::vector<double> open_;  ///< [walls_]
  bool any_ = false;
};

}  // namespace bw::cfd
