// SPDX-License-Identifier: Apache-2.0
// One program of a pair alone, against a record of the other (coupling.replay): to look into one side, or to tune it.
//
// A run that does what it did gets what it got, bit for bit. Loads are told again to a solid that takes other
// substeps, or has another material, as long as its wet surface is the recorded one (the same faces, cracks opened in
// the same windows); to a fluid whose steps end elsewhere (another grid) the surface is told between the recorded
// times, on straight lines from one to the next.
#pragma once
#include "coupling/join.h"

namespace bw::coupling {

/// join(), or where the case names a record its other side. InputError if that is none.
Joined join_or_replay(const Session& session, Role role, const CouplingCase& cs);

}  // namespace bw::coupling
