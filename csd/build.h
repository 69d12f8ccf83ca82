// SPDX-License-Identifier: Apache-2.0
// From the case to a model that can step.
#pragma once
#include "csd/case.h"
#include "csd/model.h"

namespace bw::csd {

/// Meshes, materials, initial state and forces. InputError for anything that can't be built.
Model build(const Case& cs);

}  // namespace bw::csd
