// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "coupling/channel.h"
#include "coupling/messages.h"

namespace bw::coupling {

/// HELLO both ways, checked; the same end time on all ranks of both sides: the smaller of the two [s]. Ends the run if
/// the two programs do not fit together.
struct Greeting {
  double t_end = 0;
  uint64_t features = 0;                                                                  ///< of the other program
  HelloBlock mine{}, other{};                                                             ///< as on the wire (leader)
  uint32_t minor() const { return mine.minor < other.minor ? mine.minor : other.minor; }  ///< that both speak (leader)
};
Greeting shake_hands(Channel& channel, const CouplingCase& cs, const Hello& hello);

}  // namespace bw::coupling
