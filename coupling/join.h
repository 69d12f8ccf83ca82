// SPDX-License-Identifier: Apache-2.0
// How the two programs find each other. In one mpirun each says its role, by name, over the world; started apart they
// meet by a file (port.h).
#pragma once
#include <memory>

#include "coupling/case.h"
#include "coupling/channel.h"

namespace bw::coupling {

struct Joined {
  Comm mine;                         ///< this program's ranks, in world order
  std::unique_ptr<Channel> channel;  ///< none: this program runs alone
};

/// Collective over the world, in any order of programs on the command line; with case.join "port" the world is this
/// program's. Call it when the input has been read and
/// checked: a program that dies before it joins is noticed (at once if it aborts, at case.join_limit if it hangs).
Joined join(const Comm& world, Role role, const CouplingCase& cs);
inline Joined join(const Session& session, Role role, const CouplingCase& cs) {
  return join(session.world(), role, cs);
}

}  // namespace bw::coupling
