// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "csd/physics.h"

namespace bw::csd {

/// Forces at the start, s.x and s.t given.
void first_forces(const Mesh& mesh, State& s, Physics& ph);
/// One step of central differences, from s.t to s.t + dt.
void step(Mesh& mesh, State& s, Physics& ph, double dt);

}  // namespace bw::csd
