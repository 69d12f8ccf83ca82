// SPDX-License-Identifier: Apache-2.0
// The grid: a forest of octrees with one block of cells per leaf, in Morton order, spread over the ranks. A block of
// level l has cells of h/2^l; blocks that touch are at most one level apart. All calls on the master thread, lookups on
// any.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "cfd/amr/patch.h"
#include "cfd/amr/trees.h"

namespace bw::cfd {

struct GridSize {
  Vec3 lower, upper;                  ///< corners of the domain [m]
  std::array<int, 3> cells{1, 1, 1};  ///< of level 0, any counts; 1: the direction is unused
  std::array<bool, 3> periodic{false, false, false};
  int levels = 0;                     ///< the finest level; 0: uniform
  std::array<int, 3> block{0, 0, 0};  ///< cells per block and direction; 0: choose_block
  Geometry geometry = Geometry::planar;
};

/// Cells per block and direction: the divisors of `cells` that cost least in ghosts, hanging packs and cache: long along
/// x. A prime becomes one long block.
std::array<int, 3> choose_block(const std::array<int, 3>& cells);
/// The same for a grid with `levels`: from 8 to 16 cells and a multiple of 2^levels, 1 in unused directions; 0 where no
/// divisor is.
std::array<int, 3> choose_block(const std::array<int, 3>& cells, int levels);

/// A neighbour at another level: one coarser block, or the up to eight finer ones that touch, by position
/// (4 z + 2 y + x); -1: not among them.
struct LevelJump {
  bool finer = false;
  std::array<int, 8> block{-1, -1, -1, -1, -1, -1, -1, -1};  ///< [0] if coarser
};

/// Cells of a block that another rank reads, [first, last) in each direction, and where they begin in its message.
struct Piece {
  int block;
  std::array<int, 3> first, last;
  size_t start = 0;  ///< cells
  size_t cells() const {
    return size_t(last[0] - first[0]) * size_t(last[1] - first[1]) * size_t(last[2] - first[2]);
  }
};

/// Where a block of the forest after adapt() comes from.
struct Origin {
  int change = 0;  ///< 0: it was there; 1: child of a block; -1: parent of the blocks from `old` on
  int old = 0;     ///< block before adapt()
  int child = 0;   ///< which child, in Morton order
};

class Forest {
 public:
  Forest(const Comm& comm, const GridSize& size);
  Forest(const Forest&) = delete;

  const Comm& comm() const { return comm_; }
  const GridSize& size() const { return size_; }
  int levels() const { return size_.levels; }
  /// Another number whenever the blocks or their ranks have changed.
  int64_t version() const { return version_; }
  /// Cells of any block, and the cell size of level 0, of the finest level, of a block.
  const BlockShape& shape() const { return shapes_.front(); }
  const BlockShape& finest_shape() const { return shapes_.back(); }
  const BlockShape& shape_of_level(int level) const { return shapes_[size_t(level)]; }
  const BlockShape& shape(int block) const { return shapes_[size_t(level(block))]; }
  /// Cells of the domain at a level.
  std::array<int, 3> cells_of_level(int level) const;
  int64_t global_cells() const { return global_blocks() * shape().cells(); }
  int64_t global_blocks() const { return trees_.global_leaves(); }
  /// Blocks of this rank are 0 .. local_blocks() - 1; copies of other ranks' blocks follow.
  int local_blocks() const { return local_; }
  int ghost_blocks() const { return int(leaf_.size()) - local_; }
  /// Number of a local block in the order that is the same for any number of ranks.
  int64_t global_number(int block) const { return trees_.first_leaf(comm_.rank()) + block; }
  int level(int block) const { return leaf_[size_t(block)].level; }
  /// Place of a block among the blocks of its level, and of its first cell among the level's cells.
  const std::array<int, 3>& place(int block) const { return leaf_[size_t(block)].place; }
  std::array<int, 3> first_cell(int block) const;
  /// First cell of the finest level in it, and how many cells of that level it is wide.
  std::array<int, 3> first_finest(int block) const;
  std::array<int, 3> finest_cells(int block) const;
  Vec3 lower(int block) const;   ///< lower corner [m]
  Vec3 extent(int block) const;  ///< of the block [m]

  static constexpr int outside = -1;
  /// The block of the same level at offset d in {-1, 0, 1}^3 of a local block, around periodic sides; outside: of the
  /// domain; less: another level, see jump().
  int neighbour(int block, const std::array<int, 3>& d) const {
    return neighbours_[size_t(block) * 27 + size_t((d[2] + 1) * 9 + (d[1] + 1) * 3 + d[0] + 1)];
  }
  const LevelJump& jump(int neighbour) const { return jumps_[size_t(-2 - neighbour)]; }
  /// Does a local block touch one of another level?
  bool at_jump(int block) const { return at_jump_[size_t(block)]; }
  /// All blocks that touch a local block, each once.
  std::span<const int> around(int block) const {
    return {&around_[first_around_[size_t(block)]], first_around_[size_t(block) + 1] - first_around_[size_t(block)]};
  }
  /// Cells of local blocks that a rank reads, and of its blocks that this rank reads: the same pieces in the same order
  /// on both.
  const std::vector<Piece>& pieces_to(int rank) const { return to_[size_t(rank)]; }
  const std::vector<Piece>& pieces_from(int rank) const { return from_[size_t(rank)]; }
  /// Is the lower (upper) side of the block in direction d a side of the domain that is not periodic?
  bool at_side(int block, int d, bool upper) const;
  /// Local block and cell of a point; block -1 if it is outside the domain or on another rank.
  struct Cell {
    int block = -1, i = 0, j = 0, k = 0;
  };
  Cell find(const Vec3& x) const;
  /// The block, local or a copy, that holds a cell of the finest level, and the cell of it there; block -1: neither.
  Cell find_finest(const std::array<int, 3>& cell) const;

  /// Sends the bytes of local blocks that other ranks keep copies of. mine(b): `bytes` bytes of local block b; ghosts:
  /// ghost_blocks() * bytes, in block order. level: of this level only; -1: of all.
  template <class Mine>
  void exchange(size_t bytes, const Mine& mine, void* ghosts, int level = -1) const {
    if (comm_.size() == 1) return;
    std::vector<char> nothing(bytes);
    std::vector<void*> mirror;
    for (int b : trees_.mirrors())
      mirror.push_back(b < 0 ? nothing.data() : const_cast<void*>(static_cast<const void*>(mine(b))));
    trees_.exchange(level < 0 ? 0 : level, level < 0 ? 99 : level, bytes, mirror, ghosts);
  }

  /// Changes the leaves (Trees::adapt) and tells where each comes from; blocks, neighbours and copies remain those of
  /// before, for the transfer of states, until settle(). Collective, as settle() and transfer().
  std::vector<Origin> adapt(const std::vector<int8_t>& wish);
  /// Shares the new blocks out over the ranks: these are the blocks now. True if some moved: transfer() brings theirs.
  bool settle();
  void transfer(size_t bytes, const void* from, void* to) const { trees_.transfer(bytes, from, to); }

 private:
  void make_tables();
  void make_pieces();
  void grow(Piece& piece, int reader) const;
  int find_leaf(const Leaf& leaf) const;
  int connect(int block, const std::array<int, 3>& offset);

  Comm comm_;
  GridSize size_;
  std::array<int, 3> blocks_{1, 1, 1};  ///< of level 0
  std::vector<BlockShape> shapes_;      ///< [level]
  Trees trees_;
  int local_ = 0;
  int64_t version_ = 0;
  std::vector<Leaf> leaf_;                    ///< local, then ghosts
  std::unordered_map<uint64_t, int> number_;  ///< of a leaf
  std::vector<int> neighbours_;               ///< [local][27]
  std::vector<LevelJump> jumps_;
  std::vector<uint8_t> at_jump_;      ///< [local]
  std::vector<int> around_;           ///< [first_around_[local]]
  std::vector<size_t> first_around_;  ///< [local + 1]
  std::vector<std::vector<Piece>> to_, from_;  ///< [rank]
};

}  // namespace bw::cfd
