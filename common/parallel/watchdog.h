// SPDX-License-Identifier: Apache-2.0
// An end to waits that a program can't leave: inside MPI, for processes of the run that were stopped, or that died
// before MPI could tell. mpirun ends the others when one process has ended.
#pragma once
#include <string>

namespace bw {

/// From now on for `seconds`: unless this or stop_watching() is called again, the process says `text` and ends with the
/// code. Only in programs with a Session; SIGALRM is theirs.
void watch(double seconds, int code, const std::string& text);
/// The same, asked every `seconds`, only if `is_over` says so: it runs in a signal handler.
void watch_for(bool (*is_over)(), double seconds, int code, const std::string& text);
void stop_watching();

}  // namespace bw
