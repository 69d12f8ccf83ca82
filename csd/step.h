// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>
#include <vector>

#include "csd/model.h"

namespace bw::csd {

/// Forces at the start, positions and time given.
void first_forces(Model& model);
/// One step of central differences, to t + dt.
void step(Model& model, double dt);
/// Forces from outside, from now on (nodes that cracks split off meanwhile: see Loads). The forces at the state's time are
/// exchanged too, so that each step of the coming window has them from its start to its end.
void change_given_forces(Model& model, std::vector<std::pair<NodeId, Vec3>> forces);

}  // namespace bw::csd
