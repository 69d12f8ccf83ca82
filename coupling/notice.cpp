// SPDX-License-Identifier: Apache-2.0
#include "coupling/notice.h"

#include <fmt/format.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstring>

#include "common/app/log.h"
#include "coupling/channel.h"

namespace bw::coupling {
namespace {

// Two texts, so that the handler never reads the one being written.
char text[2][256];
std::atomic<int> current{-1};

void on_sigterm(int) {
  const int i = current.load();
  if (i >= 0) {
    const ssize_t n = write(STDERR_FILENO, text[i], strlen(text[i]));
    (void)n;
    // Open MPI kills all as soon as the first one dies: the others shall come to word
    const timespec while_others_speak{.tv_sec = 0, .tv_nsec = 300'000'000};
    nanosleep(&while_others_speak, nullptr);
  }
  _exit(exit_killed);
}

}  // namespace

void set_notice(const std::string& place) {
  const int next = current == 0 ? 1 : 0;
  const std::string words = fmt::format(
      "[{}] error: ended from outside{}: another program of this run died or was killed, or the run was "
      "cancelled [exit code {}]\n",
      program_name(), place, int(exit_killed));
  text[next][words.copy(text[next], sizeof text[next] - 1)] = 0;
  if (current.exchange(next) < 0) signal(SIGTERM, on_sigterm);
}

void quiet_notice() {
  if (current.exchange(-1) >= 0) signal(SIGTERM, SIG_DFL);
}

}  // namespace bw::coupling
