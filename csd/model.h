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

/// x, v and f of all nodes become right, those too that other ranks or rigid bodies keep. Collective.
inline void complete(Model& m) {
  if (m.physics.elements.ranks) m.physics.elements.ranks->complete(m.state);
  if (m.physics.rigid) m.physics.rigid->complete(m.state);
}

}  // namespace bw::csd
