// SPDX-License-Identifier: Apache-2.0
// The one list of loads. A load: name, describe(keys), select(mesh) once, and
//   add(mesh, x, m, t, f)   adds its nodal forces [N] at positions x [m], masses m [kg], time t [s].
// A load of faces is the sum of what it does on each of them:
//   set()                       its faces
//   at(t)                       what it knows of a time, for all faces
//   on_face(i, x, now, force)   adds to force(a) [N] of the corners a of face i of the set, which are at x [m]; now: at(t)
#pragma once
#include <variant>

#include "csd/load/blast.h"
#include "csd/load/body_force.h"
#include "csd/load/gravity.h"
#include "csd/load/pressure.h"
#include "csd/load/pressure_front.h"
#include "csd/load/traction.h"

namespace bw::csd {

using LoadKind = std::variant<PressureFront, Pressure, Traction, Blast, BodyForce, Gravity>;

struct LoadCase {
  LoadKind kind;
  template <class K>
  void describe(K& k) {
    k.pick("kind", kind, "load", true);
  }
};

}  // namespace bw::csd
