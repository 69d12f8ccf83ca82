// SPDX-License-Identifier: Apache-2.0
// Blocks that no wave has reached: their nodes stand where they were made, so they bear nothing. A block once reached
// stays so, and a node moves only after a block beside it, a load or a condition has moved it: the region grows by
// connectivity, a layer a step at most, as the scheme's own domain of dependence does.
// Blocks of rigid bodies alone are passed over likewise, until they are set free.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/data/field.h"
#include "common/math/tensor.h"

namespace bw::csd {

struct Resting {
  enum State : char { unseen, computed, skipped, reached, rigid };
  bool skip = true;          ///< false: such blocks are computed all the same, with the same result
  std::vector<State> state;  ///< [block], of the last call; empty: all reached
  std::vector<char> has_moved;  ///< [node] work space: 1 if it has left where it was made
  int64_t skips = 0;         ///< blocks passed over, summed over the steps
  int64_t rigid_skips = 0;   ///< the same for those of rigid bodies

  /// Begins again: no block has been looked at.
  void start(int blocks) { state.assign(size_t(blocks), unseen); }
  bool any() const { return !state.empty(); }
  /// Whether a block may be at rest.
  bool looks() const {
    return std::any_of(state.begin(), state.end(), [](State now) { return now < reached; });
  }
  /// Whether all elements of a block, one of `blocks`, are rigid.
  void set_rigid(int block, bool is_rigid, int blocks) {
    if (state.empty()) {
      if (!is_rigid) return;
      state.assign(size_t(blocks), reached);
    }
    State& now = state[size_t(block)];
    if (is_rigid) now = rigid;
    if (!is_rigid && now == rigid) now = reached;
  }
  /// In a checkpoint; empty counts as all reached.
  template <class A>
  void keep(A a, int blocks) {
    std::vector<State> all = state;
    if (all.empty()) all.assign(size_t(blocks), reached);
    a.blocks("state", all, 1, reached);
    a.value("skips", skips), a.value("rigid_skips", rigid_skips);
    if (!a.restores()) return;
    state = all;
    if (std::count(state.begin(), state.end(), reached) == std::ptrdiff_t(state.size())) state.clear();
  }
  /// After a call. When all are reached nothing is looked at any more.
  void book() {
    skips += std::count(state.begin(), state.end(), skipped);
    rigid_skips += std::count(state.begin(), state.end(), rigid);
    if (std::count(state.begin(), state.end(), reached) == std::ptrdiff_t(state.size())) state.clear();
  }
};

/// What is needed to know them.
struct Reference {
  const Field<Vec3, NodeId>& X;
  Resting& resting;
};

}  // namespace bw::csd
