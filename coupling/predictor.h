// SPDX-License-Identifier: Apache-2.0
// The wall velocity that the solid announces for a window whose end it has not reached yet.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/parallel/loop.h"
#include "coupling/case.h"
#include "coupling/node_places.h"

namespace bw::coupling {

/// box1: v^n. Else the velocity at the middle of the coming window, v^n + r/2 (v^n - v^(n-1)) with r = (coming
/// window) / (last window), 1.5 v^n - 0.5 v^(n-1) for equal windows. A node split from a parent continues the parent's
/// history, a node that was not wet before starts with v^n.
class WallPredictor {
 public:
  explicit WallPredictor(Scheme scheme) : scheme_(scheme) {}

  /// surface.v, v^n, becomes the velocity [n_nodes] of the walls for a window expected to last dt_next.
  void predict(WetSurface& surface, double dt_next) {
    if (scheme_ == Scheme::box1) return;
    if (surface.topo_version != topo_version_ || surface.v.size() != v_last_.size()) renew(surface);
    // a sliver of a window before an output time must not blow the difference up
    const double half_ratio = dt_last_ > 0 ? 0.5 * std::clamp(dt_next / dt_last_, 0.0, 2.0) : 0;
    const auto predict_node = [&](int64_t i) {
      const Vec3 now = surface.v[size_t(i)];
      surface.v[size_t(i)] += half_ratio * (now - v_last_[size_t(i)]);
      v_last_[size_t(i)] = now;
    };
    parallel_for(int64_t(v_last_.size()), predict_node, worth_waking);
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
  /// The last velocities of its nodes.
  void renew(const WetSurface& surface) {
    topo_version_ = surface.topo_version;
    if (places_.are_of(surface)) return;  // faces have changed, nodes have not
    NodePlaces now(surface);
    std::vector<Vec3> last = surface.v;
    for (size_t i = 0; i < last.size(); ++i)
      if (const int64_t old = places_.find_or_ancestor(surface, i, now); old >= 0) last[i] = v_last_[size_t(old)];
    v_last_ = std::move(last);
    places_ = std::move(now);
  }

  Scheme scheme_;
  int64_t topo_version_ = -1;
  NodePlaces places_;         // of the nodes of v_last_
  std::vector<Vec3> v_last_;  // v^n of the last predict()
  double dt_last_ = 0;
};

}  // namespace bw::coupling
