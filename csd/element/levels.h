// SPDX-License-Identifier: Apache-2.0
// Which blocks may take longer steps.
#pragma once
#include <cstdint>
#include <vector>

namespace bw::csd {

struct Elements;
class TimeStep;
struct State;

/// [block] Level for local steps (csd/local_steps.h), from 0 to s.local.most: 2^level times the step of the element
/// that limits all is within the bound of every element of the block, with a margin where it rises. Blocks that share a
/// node with one of a lower level take that level too, and beyond those levels rise one at a time. Rigid elements ask
/// for nothing.
std::vector<uint8_t> choose_levels(const Elements& elements, const TimeStep& time_step, const State& s);

}  // namespace bw::csd
