// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "csd/mesh/topology.h"
#include "csd/physics.h"

namespace bw::csd {

/// All that a run steps through time.
struct Model {
  Mesh mesh;
  Topology topology;
  State state;
  Physics physics;
};

}  // namespace bw::csd
