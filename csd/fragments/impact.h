// SPDX-License-Identifier: Apache-2.0
// Impact of a rigid body on planes: impulses at its points, Newton's restitution with Coulomb's friction as an
// inequality [Moreau 1988], solved point by point. The energy never grows.
#pragma once
#include <vector>

#include "csd/fragments/rigid_body.h"

namespace bw::csd {

/// A point of the body that may reach a plane within the step.
struct Touch {
  Vec3 arm;             ///< m, in space
  Vec3 normal;          ///< of the plane, towards the body
  Vec3 wall;            ///< m/s, velocity of the plane
  double gap_rate = 0;  ///< m/s: an approach up to this doesn't reach the plane
  double restitution = 0, friction = 0;
  Vec3 impulse{};  ///< N s, found
  Vec3 before{};   ///< m/s, velocity of the point before, found
};

/// Changes the body's motion so that no point passes its plane. Returns false if nothing had to be done.
bool resolve(RigidBody& body, std::vector<Touch>& touches);

}  // namespace bw::csd
