// SPDX-License-Identifier: Apache-2.0
// The one place where exceptions become messages and exit codes.
#pragma once
#include <functional>
#include <stdexcept>
#include <string>

#include "common/app/error.h"
#include "common/parallel/mpi.h"

namespace bw {

/// Runs body() and returns its exit code. An exception is printed; then
/// - alone, its code is returned: InputError 2, PhysicsError 3, CodedError its own, anything else 1;
/// - with other ranks (of this program or the peer) the hook is called and MPI_Abort(code) ends all of them:
/// MPI_Finalize
///   would wait for ranks that wait for this one.
/// An exit code other than 0 that body() returns ends the same way, without a message.
int guarded(const Session& session, const std::function<int()>& body);

/// Whether this rank may speak for its program before the ranks of that know of each other: the first of those that one
/// part of mpirun's line starts. If the launcher doesn't tell (Open MPI does) every rank may.
bool is_first_of_program(const Session& session);

/// Called once with (exit code, message) before an error ends the program: coupling tells the peer why. Empty removes
/// it.
void set_failure_hook(std::function<void(int code, const std::string& message)> hook);

}  // namespace bw
