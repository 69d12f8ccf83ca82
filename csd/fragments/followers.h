// SPDX-License-Identifier: Apache-2.0
// Rigid bodies within a step where nothing looks at them but loads on faces and the elements beside them: bodies with
// loaded faces are pushed, the others fly free, and of their nodes only those beside deformable elements follow. What a
// body's faces feel is summed up from the body's own arms, in the order in which Loads would add it. The cost of a body
// that nothing touches is that of moving one point.
#pragma once
#include <cstdint>
#include <vector>

#include "csd/fragments/rigid_body.h"
#include "csd/load/loads.h"

namespace bw::csd {

class Followers {
 public:
  /// Bodies from `first` on are new, those before are as they were. loads: may be null; its forces are known at their
  /// nodes, and it has left `faces` to them. body_at: [node] place in bodies.
  void append(const std::vector<RigidBody>& bodies, size_t first, const Loads* loads, std::vector<LeftFace> faces,
              const std::vector<int32_t>& body_at);
  /// Nodes of bodies that elements beside them look at, each once.
  void set_beside(const std::vector<RigidBody>& bodies, std::vector<NodeId> nodes, const std::vector<int32_t>& body_at);

  // --- in the step, in this order
  void kick(std::vector<RigidBody>& bodies, double h);
  void place(const std::vector<RigidBody>& bodies, Field<Vec3, NodeId>& x) const;
  void clear(Field<Vec3, NodeId>& f) const;  ///< elements beside them have added theirs
  void take_forces(std::vector<RigidBody>& bodies, const Loads* loads);
  /// W, of the loads that were taken, at the velocities after the last of kick and take_forces.
  double power() const { return power_; }

  /// Forces of loads [N] at the bodies' nodes, as they were taken.
  void give_back(Loads& loads) const;

 private:
  struct Node {
    NodeId node;
    Vec3 arm, f;  // m, in the body's frame; N
  };
  struct Beside {
    NodeId node;
    Vec3 arm;
    int32_t body;
  };
  struct OnBody {
    int32_t load, face;
    std::array<int32_t, 4> corner;  // places in the body's nodes
  };
  RigidBody::Push sum(const RigidBody& body, size_t i) const;
  double power_of(const RigidBody& body, size_t i) const {
    const auto& [F, T] = load_[i];
    return T == Vec3{} ? dot(F, body.velocity()) : dot(F, body.velocity()) + dot(T, body.spin());
  }

  std::vector<int32_t> loaded_;                        // places in bodies, ascending
  std::vector<size_t> first_node_{0}, first_face_{0};  // [loaded + 1] into nodes_, faces_
  std::vector<Node> nodes_;                            // that may bear a load, ascending in each body
  std::vector<OnBody> faces_;
  std::vector<RigidBody::Push> load_;  // [loaded]
  double power_ = 0;
  std::vector<int32_t> fresh_;  // not loaded, but still pushed by the forces that they began with
  std::vector<Beside> beside_;
};

}  // namespace bw::csd
