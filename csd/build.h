// SPDX-License-Identifier: Apache-2.0
// From the case to a model that can step.
#pragma once
#include "csd/case.h"
#include "csd/model.h"

namespace bw::csd {

/// Meshes, materials, initial state and forces. InputError for anything that can't be built.
/// On several ranks all call it, and each gets the elements of its own blocks (csd/ranks).
Model build(const Case& cs, const Comm& comm = {});

}  // namespace bw::csd
