// SPDX-License-Identifier: Apache-2.0
// The wall velocity that the solid announces for a window whose end it has not reached yet.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "coupling/case.h"
#include "coupling/node_places.h"

namespace bw::coupling {

/// box1: v^n. Else the velocity at the middle of the coming window, v^n + r/2 (v^n - v^(n-1)) with r = (coming
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
    if (scheme_ != Scheme::box1 && half_ratio > 0) {
      const NodePlaces now = same ? NodePlaces{} : NodePlaces(surface);
      for (size_t i = 0; i < v.size(); ++i) {
        const int64_t old = same ? int64_t(i) : places_.find_or_ancestor(surface, i, now);
        if (old >= 0) v[i] += half_ratio * (surface.v[i] - v_last_[size_t(old)]);
      }
    }
    if (!same) places_ = NodePlaces(surface);
    topo_version_ = surface.topo_version;
    v_last_ = surface.v;
    return v;
  }

  /// The window that started with the surface of the last predict() lasted dt.
  void window_lasted(double dt) { dt_last_ = dt; }

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.value("topo_version", topo_version_), a.value("dt_last", dt_last_), a.list("v_last", v_last_);
    places_.keep(a);
  }

 private:
  Scheme scheme_;
  int64_t topo_version_ = -1;
  NodePlaces places_;         // of the nodes of v_last_
  std::vector<Vec3> v_last_;  // of the last predict()
  double dt_last_ = 0;
};

}  // namespace bw::coupling
