// SPDX-License-Identifier: Apache-2.0
#include "common/parallel/watchdog.h"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "common/app/log.h"
#include "common/parallel/mpi.h"

namespace bw {
namespace {

char last_words[512];
volatile sig_atomic_t exit_code = 1;
bool (*is_over)() = nullptr;

extern "C" void on_alarm(int) {  // what a handler may do, no more
  if (is_over && !is_over()) return;
  if (write(STDERR_FILENO, last_words, std::strlen(last_words)) < 0) _exit(exit_code);
  _exit(exit_code);
}

void set_timer(double seconds, bool again = false) {
  itimerval timer{};
  timer.it_value.tv_sec = time_t(std::ceil(seconds));
  if (again) timer.it_interval = timer.it_value;
  setitimer(ITIMER_REAL, &timer, nullptr);
}

void start(double seconds, int code, const std::string& text, bool (*condition)()) {
  if (!Session::is_there()) return;
  set_timer(0);
  const std::string name = program_name().empty() ? "" : "[" + program_name() + "] ";
  std::snprintf(last_words, sizeof last_words, "%serror: %s [exit code %d]\n", name.c_str(), text.c_str(), code);
  exit_code = code;
  is_over = condition;
  struct sigaction action {};
  action.sa_handler = on_alarm;
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  set_timer(seconds, condition != nullptr);
}

}  // namespace

void watch(double seconds, int code, const std::string& text) { start(seconds, code, text, nullptr); }
void watch_for(bool (*is_over_now)(), double seconds, int code, const std::string& text) {
  start(seconds, code, text, is_over_now);
}

void stop_watching() {
  if (Session::is_there()) set_timer(0);
}

}  // namespace bw
