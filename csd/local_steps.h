// SPDX-License-Identifier: Apache-2.0
// Local time steps: what is far from limiting the step takes one 2, 4, 8 times as long. A block of level k is evaluated
// at every 2^k-th of the shortest steps, and its forces act as impulses over 2^k of them; a node moves as often as the
// shortest step around it asks, so that a block finds all its nodes at its own time. Forces between the same nodes at
// the same time stay opposite and equal, so momenta are kept exactly, and the map is symplectic [Lew, Marsden, Ortiz,
// West, Int. J. Numer. Meth. Eng. 60 (2004) 153; Tuckerman, Berne, Martyna, J. Chem. Phys. 97 (1992) 1990].
// At the ends of a whole step, 2^top of the shortest, all are at one time: cracks, rigid bodies, output, another
// program and the choice of levels have their place there.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/data/field.h"
#include "csd/mesh/topology.h"

namespace bw::csd {

struct Blocks;

/// Who is due at each of the shortest steps. Off (top 0): all, always.
class LocalSteps {
 public:
  int most = 0;  ///< top may become so much; 0: no local steps
  int top() const { return top_; }
  bool on() const { return top_ > 0; }
  int shortest() const { return 1 << top_; }  ///< steps in a whole one
  /// i = 1 .. shortest(): the end of the i-th of the shortest steps.
  void set_now(int i) { now_ = i % shortest() == 0 ? top_ : __builtin_ctz(unsigned(i)); }
  bool all_due() const { return now_ == top_; }

  bool is_due(NodeId n) const { return !on() || node_[n] <= now_; }
  bool is_block_due(int block) const { return !on() || block_[size_t(block)] <= now_; }
  double steps_of(NodeId n) const { return on() ? double(1 << node_[n]) : 1.0; }  ///< the node's step over the shortest
  double per_step_of(NodeId n) const { return on() ? 1 / steps_of(n) : 1.0; }
  double steps_of_block(int block) const { return on() ? double(1 << block_[size_t(block)]) : 1.0; }
  /// Force evaluations of an element during a whole step, on average; shortest() would be all.
  double evaluations() const { return evaluations_; }
  int level_of_block(int block) const { return on() ? block_[size_t(block)] : 0; }
  /// Nodes that are due, ascending; empty if all are.
  const std::vector<int32_t>* due_nodes() const { return all_due() ? nullptr : &due_[size_t(now_)]; }

  /// Levels to come [block], from the end of the next whole step on; the last force evaluation before it adds up the
  /// nodes' forces for both. Nodes marked [node] move by whole steps.
  void propose(const Blocks& blocks, std::vector<uint8_t> levels, const std::vector<char>& whole, size_t nodes);
  bool is_pending() const { return next_.top >= 0; }
  double next_steps_of_block(int block) const { return double(1 << next_.block[size_t(block)]); }
  void take_next();
  /// At the end of a whole step: these nodes move by steps of a level from now on, after list_due.
  void set_level(std::span<const NodeId> nodes, int level);
  void list_due();
  /// Nodes were split.
  void append_copies(std::span<const NodeSplit> splits);

  /// In a checkpoint, between two whole steps.
  template <class A>
  void keep(A& a) {
    a.value("top", top_), a.value("now", now_), a.value("evaluations", evaluations_);
    a.list("blocks", block_), a.list("nodes", node_);
    a.value("next_top", next_.top), a.list("next_blocks", next_.block), a.list("next_nodes", next_.node);
    if (a.restores()) list_due();
  }

 private:
  struct Next {
    int top = -1;
    std::vector<uint8_t> block;
    Field<uint8_t, NodeId> node;
  };
  int top_ = 0, now_ = 0;
  double evaluations_ = 1;
  std::vector<uint8_t> block_;             // [block] level
  Field<uint8_t, NodeId> node_;            // level
  std::vector<std::vector<int32_t>> due_;  // [now < top]
  Next next_;
};

}  // namespace bw::csd
