// SPDX-License-Identifier: Apache-2.0
// The state on new leaves: kept, prolonged or averaged, so that mass, momentum and energy (with what an explosive still
// stores) stay what they are.
#pragma once
#include "cfd/amr/gather.h"
#include "cfd/source/burn.h"

namespace bw::cfd {

struct TransferInput {
  const Medium& medium;
  const Boundary& boundary;
  const Burn* burn;  ///< nullptr: no energy is stored anywhere
};

/// After Forest::adapt, with its origins: the state is that of the new leaves, which are still on their old ranks.
/// Blocks that changed get no info: rate -1. Copies of other ranks' blocks were current before.
void transfer_state(const Forest& forest, const TransferInput& in, const std::vector<Origin>& origins, State& state);

/// After Forest::settle() said that blocks moved: the state follows them.
void move_state(const Forest& forest, State& state);

}  // namespace bw::cfd
