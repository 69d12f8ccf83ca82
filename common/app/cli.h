// SPDX-License-Identifier: Apache-2.0
// The command line of both programs.
#pragma once
#include <optional>
#include <string>

#include "common/app/run_control.h"

namespace bw {

struct CommandLine {
  std::string case_file;
  bool check = false;            ///< read, check, build, and stop before the first step
  bool manual = false;           ///< print the manual of the case file and stop
  int threads = 0;               ///< 0: as the case file says
  std::string output;            ///< instead of output.directory
  std::string record, replay;    ///< instead of coupling.record, coupling.replay
  std::string restart;           ///< a checkpoint, or a folder: its latest one; empty: from the start
  double end = 0;                ///< instead of time.end, if positive
  std::optional<int> exit_code;  ///< set if everything is done already (--help, --version)

  /// The options that replace keys of the case file.
  void apply(RunControl& run) const;
};

/// Throws InputError on a wrong command line. Every rank may call it; only ranks that speak print help and version.
CommandLine read_command_line(int argc, char** argv, const std::string& program, const std::string& description);

}  // namespace bw
