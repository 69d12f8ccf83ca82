// SPDX-License-Identifier: Apache-2.0
// Where the fluid's own walls are. Under fluid_first they run a prediction ahead of the solid, and repay the gap in the
// next window.
#pragma once
#include <vector>

#include "coupling/loads.h"
#include "coupling/node_places.h"

namespace bw::coupling {

///   path.begin(window, surface);             // after FluidSide::receive
///   ... choose dt: nodes will travel from path.x() to path.x_end(dt) ...
///   v = path.velocity(dt);                   // constant over the window
///   path.end(dt);
class WallPath {
 public:
  /// Walls of known nodes stay where they went, a node split from a parent starts at the parent's wall, a new one at
  /// its x. Under box1 (not window.mean_pressure) all walls jump to x.
  void begin(const Window& window, const WetSurface& surface) {
    const bool same = surface.topo_version == topo_version_ && x_.size() == surface.x.size();
    if (!window.mean_pressure) {
      x_ = surface.x;
    } else if (!same) {
      const std::vector<Vec3> before = std::move(x_);
      NodePlaces now(surface);
      x_ = surface.x;
      for (size_t i = 0; i < x_.size(); ++i)
        if (const int64_t old = places_.find_or_ancestor(surface, i, now); old >= 0) x_[i] = before[size_t(old)];
      places_ = std::move(now);
    }
    topo_version_ = surface.topo_version;
    target_ = surface.x;
    v_ = surface.v;
  }
  /// [n_nodes] m, at the window's start.
  const std::vector<Vec3>& x() const { return x_; }
  /// Where they will be after dt: on the straight line from the solid's x with the announced velocity.
  std::vector<Vec3> x_end(double dt) const {
    std::vector<Vec3> x = target_;
    for (size_t i = 0; i < x.size(); ++i) x[i] += dt * v_[i];
    return x;
  }
  /// [n_nodes] m/s, the gap's repayment included.
  std::vector<Vec3> velocity(double dt) const {
    std::vector<Vec3> v = v_;
    for (size_t i = 0; i < v.size(); ++i) v[i] += (target_[i] - x_[i]) / dt;
    return v;
  }
  void end(double dt) { x_ = x_end(dt); }

  /// In a checkpoint, between two windows. to: section of a file; likewise from.
  template <class S>
  void save(const S& to) {
    Saving<S> a{to};
    keep(a);
  }
  template <class S>
  void restore(const S& from) {
    Restoring<S> a{from};
    keep(a);
  }

  template <class A>
  void keep(A& a) {
    std::vector<int64_t> version{topo_version_};  // as a list, which every kind of file has
    a.list("topo_version", version), a.list("wall_x", x_);
    topo_version_ = version.at(0);
    places_.keep(a);
  }

 private:
  template <class S>
  struct Saving {
    const S& to;
    template <class T>
    void list(const char* name, const std::vector<T>& a) {
      to.same(name, a);
    }
  };
  template <class S>
  struct Restoring {
    const S& from;
    template <class T>
    void list(const char* name, std::vector<T>& a) {
      a = from.template same<T>(name);
    }
  };
  int64_t topo_version_ = -1;
  NodePlaces places_;             // of x_
  std::vector<Vec3> x_;           // the walls
  std::vector<Vec3> target_, v_;  // the solid's, as announced
};

}  // namespace bw::coupling
