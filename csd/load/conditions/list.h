// SPDX-License-Identifier: Apache-2.0
// The one list of conditions. A condition: name, describe(keys), reaction, and, with s.t the time at the step's start,
//   select(mesh)          resolves its nodes; again after each crack
//   before_drift(s, dt)   s.v is the velocity of the coming step
//   on_force(s, dt)       s.v still is; s.f are the forces at the step's end
//   after_kick(s, dt)     s.v is the velocity at the step's end
#pragma once
#include <variant>

#include "csd/load/conditions/fixed.h"
#include "csd/load/conditions/rigid_wall.h"
#include "csd/load/conditions/velocity.h"

namespace bw::csd {

using ConditionKind = std::variant<Fixed, Roller, RigidWall, PrescribedVelocity>;

struct ConditionCase {
  ConditionKind kind;
  template <class K>
  void describe(K& k) {
    k.pick("kind", kind, "condition", true);
  }
};

}  // namespace bw::csd
