// SPDX-License-Identifier: Apache-2.0
// A node meets a face: the impulse between them, and what it does to both.
//
// An impulse J before positions move acts as the force J/dt at the step's beginning would. Central differences pair the
// velocities of two steps, so its work is J . (u1 + u2)/2, u1 and u2 being the relative velocities with which positions
// moved in the step before and will move in this one: the work of a lasting contact is zero, as it should be. With u
// after the kick, u1 = u - dt (a_node - a_face), accelerations by the forces without contact.
// The impulse must leave u2 . n >= target. With the gap that a step used up, target = -gap/dt <= -u1 . n; where things
// have passed already, target = min(0, -u1 . n): so J . (u1 + u2) <= 0, no energy comes from contact.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "csd/fragments/rigid_body.h"
#include "csd/fragments/supports.h"
#include "csd/state.h"

namespace bw::csd {

struct Meeting {
  std::array<NodeId, 5> nodes;           ///< the node, and those of the face
  std::array<double, 5> weight;          ///< 1, and the shape functions' negatives
  int first = 0, last = 5;               ///< those of deformable bodies
  std::array<RigidBody*, 2> body{};      ///< of the node, of the face; null: deformable
  std::array<int32_t, 2> place{-1, -1};  ///< of the bodies in the list
  std::array<Vec3, 2> arm;               ///< m, of the point at which they are pushed, in space
  Vec3 normal;                           ///< of the face
  double gap = 0, size = 0;              ///< m; size: root of the face's area
  int32_t island = 0;                    ///< the same for meetings that touch common nodes or bodies

  // set by begin() and changed by solve()
  Vec3 before;             ///< m/s, relative velocity u
  Vec3 kicked, supported;  ///< m/s, parts of u: by half a step's forces; of supports
  double softness = 0, side_softness = 0, target = 0;
  Vec3 impulse{};  ///< N s, on the node

  bool approaches() const { return dot(before, normal) < target; }
  Vec3 velocity(const State& s) const;
  Vec3 response(const State& s, const Supports& held, const Vec3& impulse) const;
  void push(State& s, const Supports& held, const Vec3& impulse) const;
};

/// Before any impulse of the step dt: relative velocities and what is wanted. restitution: between rigid bodies.
void begin(Meeting& m, const State& s, const Supports& held, double dt, double restitution);

/// Impulses of meetings that touch common nodes or bodies, found in sweeps over them. friction (Coulomb's coefficient)
/// acts where one of the two is rigid, since only these can be pushed at a common point and keep the angular momentum.
/// Returns the work [J] that they do on what is free to move; what they do in the frame of supports is never positive.
double solve(std::span<Meeting> meetings, State& s, const Supports& held, double friction);

}  // namespace bw::csd
