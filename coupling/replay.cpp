// SPDX-License-Identifier: Apache-2.0
#include "coupling/replay.h"

#include <fmt/format.h>

#include "common/app/error.h"
#include "coupling/recorded_fluid.h"
#include "coupling/recorded_solid.h"

namespace bw::coupling {

Joined join_or_replay(const Session& session, Role role, const CouplingCase& cs) {
  if (cs.replay.empty()) return join(session, role, cs);
  const Comm world = session.world();
  CouplingCase nobody_else = cs;
  nobody_else.join = "names";
  if (const Joined joined = join(world, role, nobody_else); joined.channel)
    joined.channel->fail(exit_input, "coupling.replay: in a replay each program runs alone; start one of the two");
  std::unique_ptr<StandIn> other;
  if (world.root()) try {
      if (role == Role::solid)
        other = std::make_unique<RecordedFluid>(cs.replay);
      else
        other = std::make_unique<RecordedSolid>(cs.replay);
    } catch (const InputError& e) {
      throw InputError(cs.replay_place.empty() ? e.what() : fmt::format("{}: {}", cs.replay_place, e.what()));
    }
  return {world, std::make_unique<Channel>(world, std::move(other), role)};
}

}  // namespace bw::coupling
