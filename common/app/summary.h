// SPDX-License-Identifier: Apache-2.0
// <directory>/solid_summary.json and fluid_summary.json, written when a run ends, also when it fails:
//
//   program, version, git        "csd", "0.1.0", "v0.1-3-gabc"
//   case, title                  path of the case file, its title
//   status, message              "finished" | "max_steps" | "failed" | "stopped by peer" | ..., the reason if it is not
//   "finished" ranks, threads, peak_memory_bytes steps, t [s], wall_seconds, cpu_seconds, waiting_share (0..1) rates
//   {"elements_per_second": ...} energies [J], masses [kg], momenta [kg m/s], counts, values      {name: number}, as
//   the program adds them timers                       {name: {seconds, calls, waiting (if true), inside: {...}}}
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/app/timers.h"

namespace bw {

struct Summary {
  using Numbers = std::vector<std::pair<std::string, double>>;
  std::string case_file, title, status = "finished", message;
  int ranks = 1, threads = 1;
  int64_t steps = 0;
  double t = 0;
  Numbers rates, energies, masses, momenta, counts, values;

  std::string json(const Timers& times) const;
  /// Atomically. Call it on the program's root only.
  void write(const std::string& path, const Timers& times) const;
};

}  // namespace bw
