// SPDX-License-Identifier: Apache-2.0
// Elements of rigid bodies share no node with others: loops over elements leave them as they are.
#pragma once
#include "csd/state.h"

namespace bw::csd {

/// All elements of a block are. Only of such blocks nodes may be elsewhere than their bodies (Rigid::complete).
inline bool is_rigid_block(const State& s, int block) {
  if (s.rigid.size() == 0) return false;
  for (int l = 0; l < lanes; ++l)
    if (s.rigid[SlotId(block * lanes + l)] == 0) return false;
  return true;
}

}  // namespace bw::csd
