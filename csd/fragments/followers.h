// SPDX-License-Identifier: Apache-2.0
// Rigid bodies within a step where nothing looks at them but loads and the elements beside them: bodies under load are
// pushed, the others fly free, and of their nodes only those under load or beside deformable elements follow. The cost
// of a body that nothing touches is that of moving one point.
#pragma once
#include <cstdint>
#include <vector>

#include "csd/fragments/rigid_body.h"
#include "csd/load/loads.h"

namespace bw::csd {

class Followers {
 public:
  /// Bodies from `first` on are new, those before are as they were; loads: may be null, forces known.
  void append(const std::vector<RigidBody>& bodies, size_t first, const Loads* loads);
  /// Nodes of bodies that elements beside them look at, each once; body_at: [node] place in bodies.
  void set_beside(const std::vector<RigidBody>& bodies, std::vector<NodeId> nodes, const std::vector<int32_t>& body_at);

  // --- in the step, in this order
  void kick(std::vector<RigidBody>& bodies, double h);
  void place(const std::vector<RigidBody>& bodies, Field<Vec3, NodeId>& x) const;
  void clear(Field<Vec3, NodeId>& f) const;  ///< elements beside them have added theirs
  void take_forces(std::vector<RigidBody>& bodies, const Loads* loads);
  /// W, of the loads that were taken.
  double power(const std::vector<RigidBody>& bodies) const;

 private:
  struct Node {
    NodeId node;
    Vec3 arm;  // m, in the body's frame
  };
  struct Beside {
    Node at;
    int32_t body;
  };
  RigidBody::Push sum(const RigidBody& body, size_t i, const Loads& loads) const;

  std::vector<int32_t> loaded_;        // places in bodies, ascending
  std::vector<size_t> first_{0};       // [loaded + 1] into nodes_
  std::vector<Node> nodes_;            // ascending in each body
  std::vector<RigidBody::Push> load_;  // [loaded]
  std::vector<int32_t> fresh_;         // not loaded, but still pushed by the forces that they began with
  std::vector<Beside> beside_;
};

}  // namespace bw::csd
