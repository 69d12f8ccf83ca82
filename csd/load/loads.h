// SPDX-License-Identifier: Apache-2.0
// All loads of a case as nodal forces, and the work they do.
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "csd/load/list.h"
#include "csd/load/radiation.h"
#include "csd/state.h"

namespace bw::csd {

/// Nodes whose forces a load sums, and whose velocities its work asks for; some may stand twice.
std::vector<NodeId> nodes_of_load(const Mesh& mesh, const LoadKind& load);

/// A face that somebody else sees to.
struct LeftFace {
  int32_t load, face;  ///< places in the list of loads, in the load's faces
  std::array<NodeId, 4> nodes;
};

/// Loops go over the nodes that are loaded alone.
class Loads {
 public:
  Loads(const Mesh& mesh, std::vector<LoadKind> kinds);
  /// Forces at positions s.x and time t; added to s.f of nodes that are due. Of at most `alone` nodes or faces no other
  /// thread is woken.
  void add(const Mesh& mesh, double t, State& s, int64_t alone = 256);
  /// Forces [N] from outside (a fluid), one a face, a quarter on each node, which every add() includes until they are
  /// replaced. The present ones are exchanged in s.f too. Cracks need no care: a face takes its force along to its new
  /// nodes. radiation, where begun, acts likewise.
  void replace_given(const Mesh& mesh, std::span<const Face> faces, std::vector<Vec3> forces, State& s);
  /// To be begun before replace_given.
  std::optional<Radiation> radiation;
  /// W: power of the forces of the last add() at the velocities s.v; of nodes that are due, times their steps over the
  /// shortest.
  double power(const State& s) const;
  /// The forces of the last add() act for the time h (power's meaning of due nodes).
  void book(const Mesh& mesh, const State& s, double h) {
    if (radiation) radiation->book(mesh, s, h);
  }
  /// Nodes were split; forces() of parent and children are to be shared by mass then.
  void append_copies(std::span<const NodeSplit> splits);
  /// Nodal forces of the last add() [N].
  Field<Vec3, NodeId>& forces() { return f_; }
  const Field<Vec3, NodeId>& forces() const { return f_; }
  /// It may bear a load.
  bool is_loaded(NodeId n) const { return is_loaded_[n]; }
  /// Whether each load is the sum of what it does on faces: then nodes may be left.
  bool are_on_faces() const;
  /// Nodes marked [node], to all of any face or none, get no forces and count in no power from now on, their forces()
  /// stay as they are; later nodes are not marked. Returns the faces that were not left before, in the order in which
  /// they added to their nodes: somebody else sees to them.
  std::vector<LeftFace> leave(const Mesh& mesh, const std::vector<char>& is_left);
  /// Adds to force(a) [N] what a load does at the time of the last add() to the corners of its face, which are at x
  /// [m].
  template <class Force>
  void add_on_face(int32_t load, int32_t face, const std::array<Vec3, 4>& x, const Force& force) const {
    std::visit(
        [&](const auto& l) {
          if constexpr (requires { l.faces; }) l.on_face(size_t(face), x, l.at(t_), force);
        },
        kinds_[size_t(load)]);
  }

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.list("force", f_), a.list("nodes", nodes_), a.list("loaded", is_loaded_);
    if (a.restores()) acting_ = nodes_;
    if (radiation) radiation->keep(a);
  }

 private:
  std::vector<LoadKind> kinds_;
  void follow(const std::vector<NodeId>& nodes);
  void spread_given(const Mesh& mesh);
  std::vector<Face> given_faces_;
  std::vector<Vec3> given_;        // N, on each of them
  Field<Vec3, NodeId> given_f_;    // N, of given_; empty without
  bool is_spread_ = true;          // given_f_ is up to date
  double t_ = 0;                   // s, of the last add()
  Field<Vec3, NodeId> f_;          // N
  std::vector<NodeId> nodes_;      // ascending
  std::vector<NodeId> acting_;     // those of them that are not left
  Field<char, NodeId> is_loaded_;  // in nodes_
};

}  // namespace bw::csd
