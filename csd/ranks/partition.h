// SPDX-License-Identifier: Apache-2.0
// Which rank computes which blocks of elements.
#pragma once
#include <cstdint>
#include <vector>

#include "csd/element/blocks.h"

namespace bw::csd {

/// [block] rank in [0, ranks): equal numbers of elements, few nodes between ranks (METIS). InputError if there are
/// fewer blocks than ranks.
std::vector<int32_t> assign_blocks(const Mesh& mesh, const Blocks& blocks, int ranks);

}  // namespace bw::csd
