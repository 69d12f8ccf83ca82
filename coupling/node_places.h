// SPDX-License-Identifier: Apache-2.0
// Finds the nodes of a new surface in an old one, through the splits that cracks made in between.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "coupling/surface.h"

namespace bw::coupling {

/// Places of node ids in the arrays of a surface. Ids are often sorted, and often those of the surface before with a
/// few more.
class NodePlaces {
 public:
  NodePlaces() = default;
  explicit NodePlaces(const WetSurface& surface) : sorted_(surface.node_id.size()) {
    for (size_t i = 0; i < sorted_.size(); ++i) sorted_[i] = {surface.node_id[i], int64_t(i)};
    in_order_ = std::is_sorted(sorted_.begin(), sorted_.end());
    if (!in_order_) std::sort(sorted_.begin(), sorted_.end());
  }
  /// Are the nodes of that surface these, in the same places?
  bool are_of(const WetSurface& surface) const {
    const auto is_place = [](const std::pair<int64_t, int64_t>& a, const int64_t& id) { return a.first == id; };
    return in_order_ &&
           std::equal(sorted_.begin(), sorted_.end(), surface.node_id.begin(), surface.node_id.end(), is_place);
  }
  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    std::vector<int64_t> ids, places;
    for (const auto& [id, place] : sorted_) ids.push_back(id), places.push_back(place);
    a.list("ids", ids), a.list("places", places);
    sorted_.clear();
    for (size_t i = 0; i < ids.size(); ++i) sorted_.push_back({ids[i], places[i]});
  }
  /// -1: not there.
  int64_t find(int64_t id) const {
    if (++hint_ >= sorted_.size() || sorted_[hint_].first != id)
      hint_ = size_t(std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{id, int64_t(-1)}) - sorted_.begin());
    return hint_ < sorted_.size() && sorted_[hint_].first == id ? sorted_[hint_].second : -1;
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
  std::vector<std::pair<int64_t, int64_t>> sorted_;  // id, place
  bool in_order_ = false;                            // places ascend with ids
  mutable size_t hint_ = 0;                          // the last one found
};

}  // namespace bw::coupling
