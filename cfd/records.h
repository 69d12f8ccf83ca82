// SPDX-License-Identifier: Apache-2.0
// Records of a run at points and on grids of points, from every step: gauges (fluid_gauges.csv, fluid_gauges.json),
// planes (plane_<name>_*.vtkhdf) and the map of the whole domain (map_*.vtkhdf). The same bits on any number of ranks.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cfd/overpressure.h"
#include "cfd/sample.h"
#include "common/io/checkpoint.h"
#include "common/io/csv.h"
#include "common/io/vtkhdf.h"

namespace bw::cfd {

/// Points on a grid, with what passed over each.
class Raster {
 public:
  /// A plane of the case, or with `map` the whole domain.
  Raster(const Case& cs, const Forest& forest, const PlaneCase* plane, const MapCase* map);
  bool keeps_waves() const { return maps_; }
  /// The state at t1, a step after t0; t0 < 0: the start.
  void step(const Model& m, double t0, double t1, double arrival);
  /// A file if one is due at t; last: unless the last one shows this time. Collective.
  void write_due(const Model& m, double t, bool last);
  void save(const Saved& to);
  void restore(const Model& m, const Restored& from, double t);
  int64_t points() const { return int64_t(sampler_.size()); }

 private:
  void fit(const Model& m);
  void share_waves(const Comm& comm);
  void write(const Model& m, double t);
  std::vector<VtkField> fields_of(const Model& m);

  const Case& case_;
  bool maps_, values_;
  Vec3 lower_, h_;
  std::array<int, 3> n_{1, 1, 1};
  Sampler sampler_;
  Schedule schedule_;
  VtkSeries series_;
  double t_written_ = -1;
  std::vector<Overpressure> wave_;  ///< [point]; those of other ranks are out of date
  std::vector<uint8_t> mine_;       ///< [point]
  /// A group of points whose block was at rest in this state without overpressure.
  struct Calm {
    bool calm = false;
    double U[Cons::most] = {};
  };
  std::vector<Calm> calm_;  ///< [group]
  struct Frame {
    std::vector<double> rho, p, peak, impulse, positive, arrival, duration;
    std::vector<std::vector<double>> alpha;
    std::vector<Vec3> v;
  } frame_;
};

class Records {
 public:
  /// fresh: with new files; otherwise restore() follows.
  Records(const Case& cs, const Model& m, bool fresh);
  /// Goes on with the files of a run that was checkpointed at t.
  void restore(const Model& m, const Restored& from, double t);
  void save(const Saved& to);
  /// After each step and at the start. Collective.
  void step(Model& m);
  /// The planes' and maps' last files. Collective.
  void finish(Model& m);
  /// fluid_gauges.json, also of a run that failed.
  void write_summary() const;

 private:
  /// Plain data: written to checkpoints as it is.
  struct Gauge {
    Overpressure wave;
    double q = 0, peak_q = 0, t_peak_q = 0, dynamic_impulse = 0;  ///< Pa, Pa, s, Pa s
    double in_metal = 0;                                          ///< s
  };
  double arrival_of(const Overpressure& w) const;
  void step_gauges(const Model& m);
  void open_table(bool resume, int64_t rows);

  const Case& case_;
  bool root_;
  double t_ = -1;
  Sampler points_;
  std::vector<Gauge> gauge_;
  std::optional<History> table_;
  std::vector<std::unique_ptr<Raster>> raster_;
};

}  // namespace bw::cfd
