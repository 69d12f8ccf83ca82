// SPDX-License-Identifier: Apache-2.0
// What a run writes: solid_history.csv, solid_*.vtkhdf with their series, solid_summary.json; and signs of life.
#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "common/app/progress.h"
#include "common/io/csv.h"
#include "common/io/vtkhdf.h"
#include "csd/archive.h"
#include "csd/case.h"
#include "csd/checkerboard_watch.h"
#include "csd/energy_watch.h"
#include "csd/model.h"

namespace bw::csd {

class Output {
 public:
  /// from: the model is a restored one, whose files go on.
  Output(const Case& cs, const Model& model, double t_end, const CheckpointReader* from = nullptr);
  /// In a checkpoint.
  void keep(Archive a);

  /// What is due at the state's time.
  void write_due(Model& model);
  /// After each step.
  void tick(Model& model);
  /// The next time that a step has to hit, at most the end.
  double next_time(double t) const;
  /// A file of fields now; returns its path.
  std::string write_fields(Model& model);
  /// Last rows, the summary; status as in common/app/summary.h.
  void finish(Model& model, const std::string& status, const std::string& message);
  const std::string& last_dump() const { return last_dump_; }

 private:
  void complete(Model& model);
  void write_row(Model& model);
  void write_fragment_table(Model& model);
  std::string limiter(const Model& model) const;
  double rate() const;

  const Case& case_;
  double t_end_;
  std::vector<ProbeCase> probes_;
  std::optional<History> history_;
  VtkSeries series_;
  Schedule fields_, rows_;
  Progress progress_;
  EnergyRow energy_;  // of the last row
  EnergyWatch watch_;
  Checkerboard raw_;
  CheckerboardWatch checkerboard_;
  double mass_ = 0, collapsed_ = 0;
  double pieces_ = 1;  // that nothing can break
  Vec3 momentum_;
  std::string last_dump_;
  double t_complete_ = -1, t_row_ = -1, t_fields_ = -1;
  int64_t rows_written_ = 0;  // when a checkpoint was made or read
  double element_steps_ = 0;      // evaluated since the program began
  double all_element_steps_ = 0;  // since the run began
  int64_t short_steps_ = 0;       // the shortest of local steps
  std::chrono::steady_clock::time_point start_;
  struct {
    double element_steps = 0, best = 0;  // best: 1/s
    std::chrono::steady_clock::time_point start;
  } window_;  // of a quarter of a second: what the machine gives when it is left alone
};

}  // namespace bw::csd
