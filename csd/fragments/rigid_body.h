// SPDX-License-Identifier: Apache-2.0
// A rigid body made of nodes: momentum and angular momentum are the state, what the nodes do follows from them.
// The free motion keeps both momenta exactly (they don't change) and the energy to round-off: the implicit midpoint
// rule for the angular momentum in the body's frame, which is a rotation of it [Austin, Krishnaprasad, Wang 1993],
// by the angle h |omega| (so that a spin about a principal axis is exact), five of them composed to fourth order
// [Suzuki 1990].
#pragma once
#include <type_traits>
#include <vector>

#include "common/data/field.h"
#include "common/math/attitude.h"

namespace bw::csd {

class alignas(64) RigidBody {
 public:
  enum class Motion { six_dof, translation };

  /// Of these nodes (ascending) as they move: mass, momentum and, for six_dof, angular momentum are theirs.
  RigidBody(std::vector<NodeId> nodes, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& v,
            const Field<double, NodeId>& m, Motion motion);

  const std::vector<NodeId>& nodes() const { return nodes_; }
  double mass() const { return mass_; }                    ///< kg
  double radius() const { return radius_; }                ///< m, of the farthest node
  const Vec3& centre() const { return x_; }                ///< m
  const Vec3& velocity() const { return v_; }              ///< m/s, of the centre
  const Vec3& angular_momentum() const { return L_; }      ///< kg m^2/s, about the centre
  const Vec3& spin() const { return omega_; }              ///< 1/s, in space
  Vec3 arm(size_t i) const { return turned_ * arm_[i]; }   ///< m, of a node, in space
  const Vec3& own_arm(size_t i) const { return arm_[i]; }  ///< m, in the body's frame
  Vec3 velocity_at(const Vec3& arm) const { return v_ + cross(omega_, arm); }
  double kinetic_energy() const {  ///< J
    const double flies = 0.5 * mass_ * dot(v_, v_);
    return motion_ == Motion::translation ? flies : flies + 0.5 * dot(omega_, L_);
  }
  double kinetic_product(double h) const;  ///< J, of v - h a and v + h a, by the forces that were taken
  Vec3 acceleration_at(const Vec3& arm) const;  ///< m/s^2, by the forces that were taken
  /// Change of velocity at `at` by an impulse at `from` (arms in space) per impulse.
  Vec3 response(const Vec3& at, const Vec3& from, const Vec3& impulse) const;

  /// It stays where it is from now on, whatever pushes it.
  void stop();
  bool is_stopped() const { return is_stopped_; }
  /// Impulse [N s] at an arm in space.
  void push(const Vec3& arm, const Vec3& impulse);
  /// Sums of forces [N] and of their moments about the centre [N m].
  struct Push {
    Vec3 F, T;
  };
  /// Adds a force at an arm in the body's frame.
  void add(const Vec3& own_arm, const Vec3& force, Push& push) const {
    push.F += force;
    if (motion_ == Motion::six_dof) push.T += cross(turned_ * own_arm, force);
  }
  void take(const Push& push);
  void take_forces(const Field<Vec3, NodeId>& f);
  /// Nodes' forces as the body's acceleration makes them of their masses: same sum, same moment.
  void share_forces(const Field<double, NodeId>& m, Field<Vec3, NodeId>& f) const;
  /// h times the forces that were taken.
  void kick(double h);
  /// Free motion over dt. Returns whether it turns: else all its nodes keep their velocities.
  bool drift(double dt);
  Vec3 place_of(const Vec3& own_arm) const {  ///< m
    return motion_ == Motion::translation ? x_ + own_arm : x_ + turned_ * own_arm;
  }
  void place_nodes(Field<Vec3, NodeId>& x) const;
  void move_nodes(Field<Vec3, NodeId>& v) const;

  /// All bodies of a run in a checkpoint, array by array.
  template <class A>
  static void keep(A& a, std::vector<RigidBody>& bodies) {
    std::vector<std::vector<NodeId>> nodes;
    std::vector<std::vector<Vec3>> arms;
    for (const RigidBody& body : bodies) nodes.push_back(body.nodes_), arms.push_back(body.arm_);
    a.lists("nodes", nodes), a.lists("arms", arms);
    bodies.resize(nodes.size(), RigidBody());
    for (size_t b = 0; b < bodies.size(); ++b) bodies[b].nodes_ = nodes[b], bodies[b].arm_ = arms[b];
    const auto each = [&]<class T>(const char* name, T RigidBody::*number) {
      std::vector<std::conditional_t<std::is_same_v<T, bool>, char, T>> all;
      for (const RigidBody& body : bodies) all.push_back(body.*number);
      a.list(name, all);
      for (size_t b = 0; b < bodies.size(); ++b) bodies[b].*number = all[b];
    };
    each("motion", &RigidBody::motion_), each("stopped", &RigidBody::is_stopped_);
    each("mass", &RigidBody::mass_), each("radius", &RigidBody::radius_);
    each("inverse_inertia", &RigidBody::inverse_inertia_);
    each("attitude", &RigidBody::q_), each("turned", &RigidBody::turned_);
    each("centre", &RigidBody::x_), each("velocity", &RigidBody::v_);
    each("angular_momentum", &RigidBody::L_), each("spin", &RigidBody::omega_);
    each("force", &RigidBody::F_), each("torque", &RigidBody::T_);
  }

 private:
  RigidBody() = default;
  void renew_spin();

  // what a step reads of a body comes first: one line of the cache to fly, two to be pushed, three to turn
  Vec3 x_, v_;
  double mass_ = 0;
  Motion motion_ = Motion::six_dof;
  bool is_stopped_ = false;
  Vec3 F_, T_;  // N, N m
  double radius_ = 0;
  Vec3 L_, omega_;  // kg m^2/s, 1/s
  Mat3 turned_ = Mat3::identity();
  Mat3 inverse_inertia_{};  // of the nodes' masses about the centre, body's frame; zero for translation
  Attitude q_;
  std::vector<NodeId> nodes_;
  std::vector<Vec3> arm_;  // m, in the body's frame
};

}  // namespace bw::csd
