// SPDX-License-Identifier: Apache-2.0
// Finds the nodes of a new surface in an old one, through the splits that cracks made in between.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "coupling/surface.h"

namespace bw::coupling {

/// Places of node ids in the arrays of a surface: found at once where ids are dense, as a mesh's are, else by search.
class NodePlaces {
 public:
  NodePlaces() = default;
  explicit NodePlaces(const WetSurface& surface) : ids_(surface.node_id) { index(); }
  /// Are the nodes of that surface these, in the same places?
  bool are_of(const WetSurface& surface) const { return ids_ == surface.node_id; }
  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.list("ids", ids_);
    index();
  }
  /// -1: not there.
  int64_t find(int64_t id) const {
    if (sorted_.empty()) {
      const uint64_t at = uint64_t(id) - first_;
      return at < place_.size() ? place_[at] : -1;
    }
    const auto found = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{id, int32_t(0)});
    return found != sorted_.end() && found->first == id ? found->second : -1;
  }
  /// Place here of node i of a later surface or of its nearest ancestor; -1: none was here. Parents may have been split
  /// in the same window: `now` are the places in the later surface.
  int64_t find_or_ancestor(const WetSurface& later, size_t i, const NodePlaces& now) const {
    int64_t at = int64_t(i);
    int64_t id = later.node_id[i];
    for (size_t steps = 0; steps <= later.node_id.size(); ++steps) {
      if (const int64_t place = find(id); place >= 0) return place;
      if (at < 0) return -1;  // an ancestor that is not wet, nor was it
      id = later.node_parent[size_t(at)];
      if (id < 0) return -1;
      at = now.find(id);
    }
    return -1;
  }

 private:
  void index() {
    place_.clear(), sorted_.clear();
    if (ids_.empty()) return;
    const auto [least, most] = std::minmax_element(ids_.begin(), ids_.end());
    first_ = uint64_t(*least);
    const uint64_t span = uint64_t(*most) - first_;
    const bool dense = span / 8 <= ids_.size();
    if (dense) place_.assign(size_t(span) + 1, -1);
    for (size_t i = 0; i < ids_.size(); ++i) {
      if (dense)
        place_[uint64_t(ids_[i]) - first_] = int32_t(i);
      else
        sorted_.push_back({ids_[i], int32_t(i)});
    }
    std::sort(sorted_.begin(), sorted_.end());
  }

  std::vector<int64_t> ids_;                         // by place
  uint64_t first_ = 0;                               // the least of them
  std::vector<int32_t> place_;                       // [id - first_] -1: no such id
  std::vector<std::pair<int64_t, int32_t>> sorted_;  // id, place; in place of place_ where ids are sparse
};

}  // namespace bw::coupling
