// SPDX-License-Identifier: Apache-2.0
// What a run writes: fluid_history.csv, fluid_body_*.csv, fluid_line_*.csv, fluid_*.vtkhdf with their series, what cfd/records.h keeps,
// fluid_summary.json; and signs of life.
#pragma once
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cfd/records.h"
#include "cfd/books.h"
#include "common/app/progress.h"
#include "common/io/csv.h"
#include "common/io/file.h"
#include "common/io/vtkhdf.h"

namespace bw::cfd {

class Output {
 public:
  /// from: goes on with the files of the run that wrote this; nullptr: new ones.
  Output(const Case& cs, const Model& m, double t_end, const Restored* from = nullptr);
  void save(const Saved& to);
  /// What is due at the state's time. Collective, as all below.
  void write_due(Model& m, const Books& books);
  void tick(const Model& m, double dt, size_t active_blocks);
  /// The next time that a step has to hit, at most the end.
  double next_time(double t) const;
  void finish(Model& m, const Books& books, const std::string& status, const std::string& message);

 private:
  /// The cell at x.
  FlowAt at(const Model& m, const Vec3& x) const;
  void write_row(const Model& m, const Books& books);
  void open_free_bodies(const Model& m, const int64_t* rows);
  void write_free_bodies(const Model& m);
  void write_fields(const Model& m);
  void write_lines(const Model& m);
  double updates(const Model& m) const;
  void restore(const Model& m, const Restored& from);

  const Case& case_;
  double t_end_;
  bool root_;
  struct Folder {
    explicit Folder(const std::string& path) { make_folder(path); }
  } folder_;  ///< before what opens files in it
  std::optional<History> history_;
  std::vector<History> free_bodies_;
  Records records_;
  VtkSeries series_;
  Schedule fields_, rows_;
  Progress progress_;
  double dt_ = 0, t_row_ = -1, t_fields_ = -1, active_share_ = 0;
  FluidSums first_, last_;
  SweptSums swept_;
  double p_max_ = 0, updates_before_ = 0;
  std::chrono::steady_clock::time_point start_;
};

/// One field file: density, pressure, velocity, volume fraction and covered cells of the blocks that the case wants,
/// on their levels; coarser levels hold means where there are finer ones. Collective.
void write_field_file(const std::string& path, const Case& cs, const Model& m);

/// Energy set free by the burn so far [J]: what left the stored form.
double stored_energy(const Model& m);

}  // namespace bw::cfd
