// SPDX-License-Identifier: Apache-2.0
// Signs of life: a bar with the time to go on a terminal, a plain line every 5 s anywhere else.
#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace bw {

class Progress {
 public:
  enum class Style { automatic, bar, lines, silent };
  /// max_steps 0: no limit. `automatic`: a bar if stdout is a terminal; silent on ranks that do not speak.
  Progress(double t_end, int64_t max_steps, Style style = Style::automatic);
  /// After each step. `extra` is asked only when something is printed: "dt 2.1e-9 (elem 42), energy drift 1e-6, 3.2
  /// Melem/s".
  void tick(int64_t step, double t, const std::function<std::string()>& extra);
  /// Removes the bar.
  void finish();

  /// What tick would print now; seconds: since the start.
  std::string line(int64_t step, double t, double seconds, const std::string& extra) const;

 private:
  using Clock = std::chrono::steady_clock;
  double t_end_;
  int64_t max_steps_;
  Style style_;
  Clock::time_point start_, last_;
  double t_start_ = -1;
  int64_t step_start_ = 0;
};

/// "45 s", "12 min 5 s", "3 h 20 min".
std::string shown_duration(double seconds);

}  // namespace bw
