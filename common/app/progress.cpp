// SPDX-License-Identifier: Apache-2.0
#include "common/app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "common/app/log.h"

namespace bw {

std::string shown_duration(double seconds) {
  const int64_t s = int64_t(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

Progress::Progress(double t_end, int64_t max_steps, Style style)
    : t_end_(t_end), max_steps_(max_steps), style_(style), start_(Clock::now()), last_(start_) {
  if (!speaks()) style_ = Style::silent;
  if (style_ != Style::automatic) return;
  // mpirun gives its programs a terminal of their own, whatever it writes to: the launcher knows better
  const char* wish = std::getenv("BREAKWAVE_PROGRESS");
  const std::string word = wish ? wish : isatty(STDOUT_FILENO) ? "bar" : "lines";
  style_ = word == "bar" ? Style::bar : word == "off" ? Style::silent : Style::lines;
}

std::string Progress::line(int64_t step, double t, double seconds, const std::string& extra) const {
  const double t0 = std::max(t_start_, 0.0);
  double part = t_end_ > t0 ? (t - t0) / (t_end_ - t0) : 1;  // of this run, which may be a restart
  if (max_steps_ > step_start_) part = std::max(part, double(step - step_start_) / double(max_steps_ - step_start_));
  part = std::clamp(part, 0.0, 1.0);
  const std::string to_go = part > 0 ? shown_duration(seconds * (1 - part) / part) + " to go" : "";
  const std::string tail = extra.empty() ? "" : ", " + extra;
  if (style_ != Style::bar) return fmt::format("step {} t {:.6g} s ({:.1f} %), {}{}", step, t, 100 * part, to_go, tail);
  constexpr int width = 24;
  const int full = int(part * width);
  return fmt::format("[{}{}] {:5.1f} %  step {}  t {:.4g} s  {}{}", std::string(size_t(full), '#'),
                     std::string(size_t(width - full), '.'), 100 * part, step, t, to_go, tail);
}

void Progress::tick(int64_t step, double t, const std::function<std::string()>& extra) {
  if (style_ == Style::silent) return;
  const auto now = Clock::now();
  if (t_start_ < 0) {
    t_start_ = t;
    step_start_ = step;
  }
  if (now - last_ < std::chrono::milliseconds(style_ == Style::bar ? 200 : 5000)) return;
  last_ = now;
  const std::string text = line(step, t, std::chrono::duration<double>(now - start_).count(), extra ? extra() : "");
  if (style_ == Style::bar)
    show_status(text);
  else
    say_line(text);
}

void Progress::finish() {
  if (style_ == Style::bar) show_status("");
}

}  // namespace bw
