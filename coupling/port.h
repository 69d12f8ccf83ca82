// SPDX-License-Identifier: Apache-2.0
// The second way to join: two programs that were not started together meet by a file. The solid opens an MPI port and
// writes where it is; the fluid reads the file and connects. Bytes: PROTOCOL.md.
#pragma once
#include "coupling/join.h"

namespace bw::coupling {

/// Collective over `mine`, all of this program's ranks. The file appears and is gone when the two have met; one that a
/// dead run left behind is passed over. Ends the run with code 73 if the other program doesn't come within
/// case.join_limit, or if MPI can't join the two.
Joined join_by_port(const Comm& mine, Role role, const CouplingCase& cs);

}  // namespace bw::coupling
