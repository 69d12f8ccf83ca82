// SPDX-License-Identifier: Apache-2.0
// p4est's part of the grid: an octree per block of level 0, its leaves in Morton order over the ranks, never more than
// one level apart over faces, edges and corners. p4est knows three directions only: in a direction that is not used a
// leaf counts if it lies at the bottom, the others carry nothing.
// All calls on the master thread; all but leaves(), ghosts() and mirrors() are collective.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/parallel/mpi.h"

namespace bw::cfd {

/// A leaf: its place counts leaves of its own level from the domain's corner; level -1: it carries no block.
struct Leaf {
  int level = 0;
  std::array<int, 3> place{0, 0, 0};
  friend bool operator==(const Leaf&, const Leaf&) = default;
};

class Trees {
 public:
  Trees(const Comm& comm, const std::array<int, 3>& blocks, const std::array<bool, 3>& periodic,
        const std::array<bool, 3>& used);
  ~Trees();
  Trees(const Trees&) = delete;

  /// Leaves of this rank that carry a block.
  const std::vector<Leaf>& leaves() const { return leaves_; }
  /// Leaves of other ranks around them, and which of mine others keep copies of (number among leaves(), -1: none).
  const std::vector<Leaf>& ghosts() const { return ghosts_; }
  const std::vector<int>& mirrors() const { return mirrors_; }
  /// The rank that owns ghosts()[i].
  int ghost_rank(int i) const;
  int64_t global_leaves() const { return first_.back(); }
  int64_t first_leaf(int rank) const { return first_[size_t(rank)]; }

  /// Splits the leaves with wish 1 in eight, joins families that all have wish -1, then splits what the balance needs.
  /// wish [leaves()]. leaves() are the new ones afterwards, on the rank of the old ones; ghosts() and mirrors() wait
  /// for partition().
  void adapt(const std::vector<int8_t>& wish);
  /// Shares the leaves out evenly, families on one rank. True if any leaf moved: transfer() then brings what is theirs.
  bool partition();
  /// from: `bytes` per leaf before the last partition(), to: after it.
  void transfer(size_t bytes, const void* from, void* to) const;
  /// mirror: one pointer per mirrors(); ghosts: bytes per ghosts(). Leaves of levels [lowest, highest] only.
  void exchange(int lowest, int highest, size_t bytes, std::vector<void*>& mirror, void* ghosts) const;

 private:
  struct P4est;
  void read_leaves();
  void read_ghosts();
  bool counts(const std::array<int, 3>& corner) const;

  Comm comm_;
  std::array<int, 3> blocks_;
  std::array<bool, 3> used_;
  std::vector<Leaf> leaves_, ghosts_;
  std::vector<int> mirrors_;
  std::vector<int64_t> first_, first_before_;  ///< [rank + 1] of the leaves that carry a block; before partition()
  std::unique_ptr<P4est> p4est_;
};

}  // namespace bw::cfd
