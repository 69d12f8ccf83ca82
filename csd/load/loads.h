// SPDX-License-Identifier: Apache-2.0
// All loads of a case as nodal forces, and the work they do.
#pragma once
#include <span>
#include <vector>

#include "csd/load/list.h"
#include "csd/state.h"

namespace bw::csd {

class Loads {
 public:
  Loads(const Mesh& mesh, std::vector<LoadKind> kinds);
  /// Forces at positions s.x and time t; added to s.f.
  void add(const Mesh& mesh, double t, State& s);
  /// Forces from outside (a fluid) instead of computed ones: the next add() also adds these [N], until they are replaced.
  void set_given(std::vector<std::pair<NodeId, Vec3>> forces) { given_ = std::move(forces); }
  /// W: power of the forces of the last add() at the velocities s.v.
  double power(const State& s) const;
  /// A node was split: its force is shared by mass, so that accelerations stay.
  void append_copies(std::span<const NodeId> parents);
  Field<Vec3, NodeId>& forces() { return f_; }

 private:
  std::vector<LoadKind> kinds_;
  std::vector<std::pair<NodeId, Vec3>> given_;
  Field<Vec3, NodeId> f_;  // N
};

}  // namespace bw::csd
