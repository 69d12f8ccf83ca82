// SPDX-License-Identifier: Apache-2.0
// The one list of conditions. A condition: name, describe(keys), reaction, and, with s.t the time at the step's start,
//   select(mesh)          resolves its nodes; again after each crack
//   before_drift(s, dt)   s.v is the velocity of the coming step
//   on_force(s, dt)       s.v still is; s.f are the forces at the step's end
//   after_kick(s, dt)     s.v is the velocity at the step's end
// and if it is so: is_pull (a force like a load's, before the others hold its nodes), is_last (acts on the forces that
// the others leave), is_tie (moves forces before the others take theirs, and velocities after them), omega2(s)
// (stiffness of its own, 1/s^2).
#pragma once
#include <variant>

#include "csd/load/conditions/damping.h"
#include "csd/load/conditions/displacement.h"
#include "csd/load/conditions/fixed.h"
#include "csd/load/conditions/rigid_wall.h"
#include "csd/load/conditions/spring.h"
#include "csd/load/conditions/symmetry.h"
#include "csd/load/conditions/tie.h"
#include "csd/load/conditions/velocity.h"

namespace bw::csd {

using ConditionKind =
    std::variant<Fixed, Roller, Symmetry, RigidWall, PrescribedVelocity, PrescribedDisplacement, Spring, Damping, Tie>;

struct ConditionCase {
  ConditionKind kind;
  template <class K>
  void describe(K& k) {
    k.pick("kind", kind, "condition", true);
  }
};

}  // namespace bw::csd
