// SPDX-License-Identifier: Apache-2.0
// The last words of a program that is ended from outside: mpirun sends SIGTERM to all when one process has died.
#pragma once
#include <string>

namespace bw::coupling {

/// From now on SIGTERM prints "ended from outside<place>: ..." and exits with exit_killed. Replaces the text if set
/// before.
void set_notice(const std::string& place);
/// From now on SIGTERM ends the program as it would without all this, silently.
void quiet_notice();

}  // namespace bw::coupling
