// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "csd/model.h"

namespace bw::csd {

/// Forces at the start, positions and time given.
void first_forces(Model& model);
/// One step of central differences, to t + dt.
void step(Model& model, double dt);
/// Bound of the stable step of elements and conditions at the present state [s].
double stable_step(Model& model);
/// Forces [N] from outside on faces, from now on, one each. Those at the state's time are exchanged too, so that each
/// step of the coming window has them from its start to its end.
void change_given_forces(Model& model, std::span<const Face> faces, std::vector<Vec3> forces);

}  // namespace bw::csd
