// SPDX-License-Identifier: Apache-2.0
// The grid: a p4est brick with one block of cells per leaf, in Morton order, spread over the ranks. One level for now.
// All calls on the master thread.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "cfd/amr/patch.h"
#include "common/parallel/mpi.h"

namespace bw::cfd {

struct GridSize {
  Vec3 lower, upper;                  ///< corners of the domain [m]
  std::array<int, 3> cells{1, 1, 1};  ///< any counts; 1: the direction is unused
  std::array<bool, 3> periodic{false, false, false};
};

/// Cells per block and direction: the divisor of `cells` that costs least in ghosts, hanging packs and cache. A count
/// without divisors in [8, 32] (a prime) becomes one long block.
std::array<int, 3> choose_block(const std::array<int, 3>& cells);

class Forest {
 public:
  Forest(const Comm& comm, const GridSize& size);
  ~Forest();
  Forest(const Forest&) = delete;

  const Comm& comm() const { return comm_; }
  const GridSize& size() const { return size_; }
  const BlockShape& shape() const { return shape_; }
  int64_t global_cells() const { return int64_t(size_.cells[0]) * size_.cells[1] * size_.cells[2]; }
  int64_t global_blocks() const { return int64_t(blocks_[0]) * blocks_[1] * blocks_[2]; }
  /// Blocks of this rank are 0 .. local_blocks() - 1; copies of other ranks' blocks follow.
  int local_blocks() const { return local_; }
  int ghost_blocks() const { return int(place_.size()) - local_; }
  /// Number of a local block in the order that is the same for any number of ranks.
  int64_t global_number(int block) const { return first_global_ + block; }
  /// Place of a block among the blocks, and of its first cell among the cells.
  const std::array<int, 3>& place(int block) const { return place_[size_t(block)]; }
  std::array<int, 3> first_cell(int block) const;
  Vec3 lower(int block) const;  ///< lower corner [m]
  /// The block at offset d in {-1, 0, 1}^3 of a local block, around periodic sides; -1: outside the domain.
  int neighbour(int block, const std::array<int, 3>& d) const {
    return neighbours_[size_t(block) * 27 + size_t((d[2] + 1) * 9 + (d[1] + 1) * 3 + d[0] + 1)];
  }
  /// Is the lower (upper) side of the block in direction d a side of the domain that is not periodic?
  bool at_side(int block, int d, bool upper) const {
    return !size_.periodic[d] && place_[size_t(block)][d] == (upper ? blocks_[d] - 1 : 0);
  }
  /// Local block and cell of a point; block -1 if it is outside the domain or on another rank.
  struct Cell {
    int block = -1, i = 0, j = 0, k = 0;
  };
  Cell find(const Vec3& x) const;

  /// Sends the bytes of local blocks that other ranks keep copies of. mine(b): `bytes` bytes of local block b; ghosts:
  /// ghost_blocks() * bytes, in block order.
  template <class Mine>
  void exchange(size_t bytes, const Mine& mine, void* ghosts) const {
    if (comm_.size() == 1) return;
    std::vector<void*> mirror;
    for (int b : mirrors_) mirror.push_back(const_cast<void*>(static_cast<const void*>(mine(b))));
    exchange_bytes(bytes, mirror, ghosts);
  }

 private:
  struct Trees;  // p4est's part
  void exchange_bytes(size_t bytes, std::vector<void*>& mirror, void* ghosts) const;
  void make_neighbours();

  Comm comm_;
  GridSize size_;
  BlockShape shape_;
  std::array<int, 3> blocks_{1, 1, 1};
  int local_ = 0;
  int64_t first_global_ = 0;
  std::vector<std::array<int, 3>> place_;  ///< local, then ghosts
  std::vector<int> neighbours_;            ///< [local][27]
  std::vector<int> mirrors_;               ///< local blocks that others keep copies of, in p4est's order
  std::unique_ptr<Trees> trees_;
};

}  // namespace bw::cfd
