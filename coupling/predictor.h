// SPDX-License-Identifier: Apache-2.0
// The wall velocity that the solid announces for a window whose end it has not reached yet.
#pragma once
#include <algorithm>
#include <cstdint>
#include <unordered_map>
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
      std::unordered_map<int64_t, int64_t> parent;
      if (!same)
        for (size_t i = 0; i < v.size(); ++i) parent[surface.node_id[i]] = surface.node_parent[i];
      for (size_t i = 0; i < v.size(); ++i) {
        const int64_t old = same ? int64_t(i) : find(surface.node_id[i], parent);
        if (old >= 0) v[i] += half_ratio * (surface.v[i] - v_last_[size_t(old)]);
      }
    }
    if (!same) {
      index_.clear();
      for (size_t i = 0; i < v.size(); ++i) index_[surface.node_id[i]] = int64_t(i);
      topo_version_ = surface.topo_version;
    }
    v_last_ = surface.v;
    return v;
  }

  /// The window that started with the surface of the last predict() lasted dt.
  void window_lasted(double dt) { dt_last_ = dt; }

 private:
  /// Place of the node, or of its nearest ancestor, in the last surface; -1: none.
  int64_t find(int64_t id, const std::unordered_map<int64_t, int64_t>& parent) const {
    for (size_t steps = 0; id >= 0 && steps <= parent.size();
         ++steps) {  // parents may have been split in the same window
      if (const auto old = index_.find(id); old != index_.end()) return old->second;
      const auto up = parent.find(id);
      if (up == parent.end()) return -1;
      id = up->second;
    }
    return -1;
  }

  Scheme scheme_;
  int64_t topo_version_ = -1;
  std::unordered_map<int64_t, int64_t> index_;  // node_id -> place in v_last_
  std::vector<Vec3> v_last_;                    // of the last predict()
  double dt_last_ = 0;
};

}  // namespace bw::coupling
