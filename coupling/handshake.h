// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "coupling/channel.h"
#include "coupling/messages.h"

namespace bw::coupling {

/// HELLO both ways, checked; the same end time on all ranks of both sides: the smaller of the two [s]. Ends the run if
/// the two programs do not fit together.
/// features: bits of the other program.
double shake_hands(Channel& channel, const CouplingCase& cs, const Hello& hello, uint64_t* features = nullptr);

}  // namespace bw::coupling
