// SPDX-License-Identifier: Apache-2.0
// The wall velocity that the solid announces for a window whose end it has not reached yet.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "coupling/case.h"
#include "coupling/surface.h"

namespace bw::coupling {

/// box1: v^n. fluid_first: the velocity at the middle of the coming window, v^n + r/2 (v^n - v^(n-1)) with r = (coming
/// window) / (last window), 1.5 v^n - 0.5 v^(n-1) for equal windows. A node split from a parent continues the parent's
/// history, a node that was not wet before starts with v^n.
class WallPredictor {
 public:
  explicit WallPredictor(Scheme scheme) : scheme_(scheme) {}

  /// Velocities [n_nodes] of the walls for a window expected to last dt_next; surface.v is v^n.
  std::vector<Vec3> predict(const WetSurface& surface, double dt_next) {
    std::vector<Vec3> v = surface.v;
    // a sliver of a window before an output time must not blow the difference up
    const double half_ratio = dt_last_ > 0 ? 0.5 * std::clamp(dt_next / dt_last_, 0.0, 2.0) : 0;
    const bool same = surface.topo_version == topo_version_ && v.size() == v_last_.size();
    if (scheme_ == Scheme::fluid_first && half_ratio > 0) {
      const Places now = same ? Places{} : Places(surface.node_id);
      for (size_t i = 0; i < v.size(); ++i) {
        const int64_t old = same ? int64_t(i) : ancestor(surface, i, now);
        if (old >= 0) v[i] += half_ratio * (surface.v[i] - v_last_[size_t(old)]);
      }
    }
    if (!same) places_ = Places(surface.node_id);
    topo_version_ = surface.topo_version;
    v_last_ = surface.v;
    return v;
  }

  /// The window that started with the surface of the last predict() lasted dt.
  void window_lasted(double dt) { dt_last_ = dt; }

 private:
  /// Where an id stands in a list that is often sorted, and often the list before with a few ids more.
  class Places {
   public:
    Places() = default;
    explicit Places(const std::vector<int64_t>& ids) {
      for (size_t i = 0; i < ids.size(); ++i) sorted_.push_back({ids[i], int64_t(i)});
      if (!std::is_sorted(sorted_.begin(), sorted_.end())) std::sort(sorted_.begin(), sorted_.end());
    }
    int64_t find(int64_t id) const {
      if (++hint_ >= sorted_.size() || sorted_[hint_].first != id)
        hint_ = size_t(std::lower_bound(sorted_.begin(), sorted_.end(), std::pair{id, int64_t(-1)}) - sorted_.begin());
      return hint_ < sorted_.size() && sorted_[hint_].first == id ? sorted_[hint_].second : -1;
    }

   private:
    std::vector<std::pair<int64_t, int64_t>> sorted_;  // id, place
    mutable size_t hint_ = 0;
  };

  /// Place in the last surface of node i or of its nearest ancestor; -1: none. Parents may have been split in the same
  /// window.
  int64_t ancestor(const WetSurface& surface, size_t i, const Places& now) const {
    int64_t id = surface.node_id[i], at = int64_t(i);
    for (size_t steps = 0; steps <= surface.node_id.size(); ++steps) {
      if (const int64_t old = places_.find(id); old >= 0) return old;
      if (at < 0) return -1;  // an ancestor that is not wet, nor was it
      id = surface.node_parent[size_t(at)];
      if (id < 0) return -1;
      at = now.find(id);
    }
    return -1;
  }

  Scheme scheme_;
  int64_t topo_version_ = -1;
  Places places_;             // of the nodes of v_last_
  std::vector<Vec3> v_last_;  // of the last predict()
  double dt_last_ = 0;
};

}  // namespace bw::coupling
