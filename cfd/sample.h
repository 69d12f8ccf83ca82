// SPDX-License-Identifier: Apache-2.0
// The flow at points. A value is linear between the centres of the cells around the point, in each direction that is
// used (2, 4 or 8 cells); primitive variables are interpolated. Beside another level and at sides of the domain the
// cells are those that the flow itself sees there. Cells in metal have no part; no link through a wall is crossed.
#pragma once
#include <vector>

#include "cfd/build.h"
#include "common/parallel/loop.h"

namespace bw::cfd {

struct FlowAt {
  double rho = 0, p = 0;
  Vec3 v;
  double alpha[most_materials] = {};  ///< Medium::told_fractions() of them
};

class Sampler {
 public:
  explicit Sampler(std::vector<Vec3> points) : points_(std::move(points)) {}
  size_t size() const { return points_.size(); }
  const Vec3& point(size_t i) const { return points_[i]; }
  /// Copies of other ranks' blocks are needed for the next sample (exchange_state).
  bool needs_copies(const Model& m);
  /// Calls see(point, flow) for the points in blocks of this rank, on all threads, each point once; flow is nullptr
  /// where the point is in metal. Blocks for which skip(group) is true are left out. Points of no block: outside the
  /// domain.
  template <class Skip, class See>
  void sample(const Model& m, const Skip& skip, const See& see) {
    fit(m);
    each_group(int(groups_.size()), [&](int g, Space& space) {
      if (skip(g)) return;
      begin(m, groups_[size_t(g)], space);
      for (size_t n = groups_[size_t(g)].first; n < groups_[size_t(g)].last; ++n) {
        FlowAt flow;
        see(size_t(place_[n].point), value(m, groups_[size_t(g)], place_[n], space, flow) ? &flow : nullptr);
      }
    });
  }
  /// Blocks that hold points: group -> block and its points. As of the last sample.
  int groups() const { return int(groups_.size()); }
  int block_of(int group) const { return groups_[size_t(group)].block; }
  template <class See>
  void each_point(int group, const See& see) const {
    for (size_t n = groups_[size_t(group)].first; n < groups_[size_t(group)].last; ++n) see(size_t(place_[n].point));
  }
  /// Finds the blocks of the points if the forest is another one than before; true then.
  bool fit(const Model& m);
  bool fitted() const { return version_ >= 0; }
  bool outdated(const Model& m) const { return version_ != m.forest.version(); }

 private:
  struct Place {
    int point = 0;
    int home[3];      ///< the cell that holds the point
    int step[3];      ///< -1, 0, 1: where the other cell lies
    double share[3];  ///< of the other cell
  };
  struct Group {
    int block = 0;
    size_t first = 0, last = 0;
    bool ghosts = false;
  };
  struct Space {
    Patch patch;
    LevelGhosts ghosts;
  };
  template <class Body>
  void each_group(int n, const Body& body);
  void begin(const Model& m, const Group& group, Space& space) const;
  bool value(const Model& m, const Group& group, const Place& at, const Space& space, FlowAt& flow) const;
  Place place(const Model& m, int point, const Forest::Cell& cell) const;

  std::vector<Vec3> points_;
  int64_t version_ = -1;
  std::vector<Group> groups_;
  std::vector<Place> place_;  ///< by group
  std::vector<Space> spaces_;
};

template <class Body>
void Sampler::each_group(int n, const Body& body) {
  parallel_for_dynamic(n, spaces_, [&](int64_t g, Space& space) { body(int(g), space); });
}

}  // namespace bw::cfd
