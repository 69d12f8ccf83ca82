// SPDX-License-Identifier: Apache-2.0
// Which nodes every rank must follow: those whose loads and reactions are summed over the model in each step.
#pragma once
#include <vector>

#include "common/math/units.h"
#include "csd/load/conditions/list.h"
#include "csd/load/list.h"

namespace bw::csd {

/// [node] The nodes of conditions (after select), of loaded faces and of loaded elements; all nodes if a load acts on
/// everything (gravity), or a rigid wall follows the momenta of bodies.
std::vector<char> nodes_needed_everywhere(const Mesh& mesh, const std::vector<LoadCase>& loads,
                                          const std::vector<ConditionKind>& conditions);

}  // namespace bw::csd
