// SPDX-License-Identifier: Apache-2.0
// When a checkpoint is due: every so many steps, every interval of simulated or of wall-clock time, and when the
// program gets the signal USR1. Checkpoints don't change the steps: one is written after the step that passed the time.
#pragma once
#include <chrono>
#include <cstdint>

#include "common/app/run_control.h"
#include "common/parallel/mpi.h"

namespace bw {

class CheckpointClock {
 public:
  /// From here on the process survives USR1 and notes it. t, step: where the run starts or goes on.
  CheckpointClock(const RunControl::Checkpoint& rules, double t, int64_t step);
  /// This process finds that one is due now; a signal is used up. Once after each step.
  bool wanted(double t, int64_t step);
  /// The same for all ranks together: any of them finds so. Collective.
  bool due(double t, int64_t step, const Comm& comm) { return comm.max(int64_t(wanted(t, step))) > 0; }
  int keep() const { return rules_.keep; }

 private:
  RunControl::Checkpoint rules_;
  Schedule times_;
  int64_t step_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace bw
