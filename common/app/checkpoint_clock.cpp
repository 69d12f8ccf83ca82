// SPDX-License-Identifier: Apache-2.0
#include "common/app/checkpoint_clock.h"

#include <csignal>

namespace bw {

namespace {

volatile std::sig_atomic_t signalled = 0;
void note_signal(int) { signalled = 1; }

}  // namespace

CheckpointClock::CheckpointClock(const RunControl::Checkpoint& rules, double t, int64_t step)
    : rules_(rules), times_(rules.every, Schedule::Zero::never), step_(step), last_(std::chrono::steady_clock::now()) {
  times_.skip_to(t);
  std::signal(SIGUSR1, note_signal);
}

bool CheckpointClock::wanted(double t, int64_t step) {
  const auto now = std::chrono::steady_clock::now();
  bool due = times_.due(t);
  if (rules_.every_steps > 0 && step / rules_.every_steps > step_ / rules_.every_steps) due = true;
  if (rules_.every_wall > 0 && std::chrono::duration<double>(now - last_).count() >= rules_.every_wall) due = true;
  step_ = step;
  if (signalled) signalled = 0, due = true;
  if (due) last_ = now;
  return due;
}

}  // namespace bw
