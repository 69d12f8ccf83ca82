// SPDX-License-Identifier: Apache-2.0
#include "cfd/records.h"

#include <fmt/format.h>

#include "common/app/log.h"
#include "common/io/file.h"
#include "common/io/json.h"

namespace bw::cfd {
namespace {

std::vector<History::Column> columns_of(const Case& cs) {
  std::vector<History::Column> c{{"t", "s"}};
  for (const GaugeCase& g : cs.fluid.gauge) {
    c.push_back({g.name + " pressure", "Pa"});
    c.push_back({g.name + " impulse", "Pa s"});
    c.push_back({g.name + " density", "kg/m^3"});
    c.push_back({g.name + " speed", "m/s"});
    c.push_back({g.name + " overpressure", "Pa"});
    c.push_back({g.name + " dynamic pressure", "Pa"});
    for (int k = 0; k < told_fractions(cs.fluid.material.size()); ++k) c.push_back({g.name + " " + cs.fluid.material[size_t(k)].name, "1"});
  }
  return c;
}

std::vector<Vec3> positions(const Case& cs) {
  std::vector<Vec3> x;
  for (const GaugeCase& g : cs.fluid.gauge) x.push_back(g.position);
  return x;
}

}  // namespace

Records::Records(const Case& cs, const Model& m, bool fresh)
    : case_(cs), root_(m.forest.comm().root()), points_(positions(cs)), gauge_(cs.fluid.gauge.size()) {
  for (const PlaneCase& p : cs.fluid.plane) raster_.push_back(std::make_unique<Raster>(cs, m.forest, &p, nullptr));
  if (cs.fluid.map) raster_.push_back(std::make_unique<Raster>(cs, m.forest, nullptr, &*cs.fluid.map));
  if (fresh) open_table(false, 0);
}

void Records::open_table(bool resume, int64_t rows) {
  if (!root_ || gauge_.empty()) return;
  const std::string path = case_.run.output.directory + "/fluid_gauges.csv";
  table_.reset();
  if (resume)
    table_.emplace(History::resume_rows(path, columns_of(case_), rows));
  else
    table_.emplace(path, columns_of(case_));
}

double Records::arrival_of(const Overpressure& w) const {
  return case_.fluid.arrival_overpressure > 0 ? case_.fluid.arrival_overpressure : 0.01 * w.p0;
}

void Records::step(Model& m) {
  if ((gauge_.empty() && raster_.empty()) || m.state.t == t_) return;
  exchange_state(m.forest, m.state);
  if (!gauge_.empty()) step_gauges(m);
  for (const auto& r : raster_) {
    r->step(m, t_, m.state.t, case_.fluid.arrival_overpressure);
    r->write_due(m, m.state.t, false);
  }
  t_ = m.state.t;
}

void Records::step_gauges(const Model& m) {
  const size_t fractions = size_t(m.setup.medium.told_fractions()), width = 4 + fractions;
  std::vector<double> values(width * gauge_.size());  // rho, p, 1 where there is fluid, speed, volume fractions
  points_.sample(
      m, [](int) { return false; },
      [&](size_t i, const FlowAt* flow) {
        if (!flow) return;
        double* v = &values[width * i];
        v[0] = flow->rho, v[1] = flow->p, v[2] = 1, v[3] = norm(flow->v);
        std::copy_n(flow->alpha, fractions, v + 4);
      });
  m.forest.comm().sum(values);
  const double t = m.state.t, dt = t_ < 0 ? 0 : t - t_;
  std::vector<double> row{t};
  for (size_t i = 0; i < gauge_.size(); ++i) {
    const double* v = &values[width * i];
    Gauge& g = gauge_[i];
    const bool fluid = v[2] > 0;
    const double q = 0.5 * v[0] * v[3] * v[3];
    if (t_ < 0) {
      g.wave.begin(fluid ? v[1] : case_.coupling.reference_pressure);
      if (!fluid) warn("gauge \"{}\" is in metal at the start: it feels nothing there", case_.fluid.gauge[i].name);
    } else {
      g.wave.add(t_, t, fluid ? v[1] : g.wave.p0, arrival_of(g.wave));
    }
    g.dynamic_impulse += 0.5 * dt * (g.q + q);
    g.q = q;
    if (q > g.peak_q) g.peak_q = q, g.t_peak_q = t;
    if (!fluid) g.in_metal += dt;
    for (const double value : {g.wave.p0 + g.wave.now, g.wave.impulse, v[0], v[3], g.wave.now, q}) row.push_back(value);
    row.insert(row.end(), v + 4, v + width);
  }
  if (table_) table_->row(row);
}

void Records::write_summary() const {
  if (!root_ || gauge_.empty()) return;
  std::vector<JsonObject> list;
  for (size_t i = 0; i < gauge_.size(); ++i) {
    const Gauge& g = gauge_[i];
    const Vec3& x = case_.fluid.gauge[i].position;
    JsonObject o;
    o.add("name", case_.fluid.gauge[i].name);
    o.add("position", std::vector<double>{x.x, x.y, x.z});
    o.add("pressure_at_start", g.wave.p0);
    o.add("peak_overpressure", g.wave.peak);
    o.add("peak_time", g.wave.t_peak);
    o.add("arrived", g.wave.arrival >= 0);
    const double none = std::nan("");
    o.add("arrival_time", g.wave.arrival >= 0 ? g.wave.arrival : none);
    o.add("positive_phase_over", g.wave.end >= 0);
    o.add("positive_duration", g.wave.end >= 0 ? g.wave.duration() : none);
    o.add("positive_impulse", g.wave.arrival >= 0 ? g.wave.positive_impulse : 0.0);
    o.add("impulse", g.wave.impulse);
    o.add("peak_dynamic_pressure", g.peak_q);
    o.add("peak_dynamic_pressure_time", g.t_peak_q);
    o.add("dynamic_impulse", g.dynamic_impulse);
    if (g.in_metal > 0) o.add("time_in_metal", g.in_metal);
    list.push_back(o);
  }
  JsonObject all;
  all.add("t", t_);
  all.add("units", "SI: m, s, Pa, Pa s");
  all.add("gauges", list);
  write_atomically(case_.run.output.directory + "/fluid_gauges.json", all.text() + "\n");
}

void Records::finish(Model& m) {
  step(m);
  for (const auto& r : raster_) r->write_due(m, m.state.t, true);
}

void Records::save(const Saved& to) {
  to.number("t", t_);
  to.same("gauges", gauge_);
  to.number("rows", table_ ? table_->rows() : int64_t(0));
  if (table_) table_->flush();
  for (size_t i = 0; i < raster_.size(); ++i) raster_[i]->save(to.section(fmt::format("raster{}", i)));
}

void Records::restore(const Model& m, const Restored& from, double t) {
  t_ = from.number<double>("t");
  gauge_ = from.same<Gauge>("gauges");
  open_table(true, from.number<int64_t>("rows"));
  for (size_t i = 0; i < raster_.size(); ++i) raster_[i]->restore(m, from.section(fmt::format("raster{}", i)), t);
}

}  // namespace bw::cfd
