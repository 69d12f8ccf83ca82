// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cfd/records.h"

namespace bw::cfd {
namespace {

constexpr int64_t most_points = 20'000'000;

std::string stem_of(const PlaneCase* plane) { return plane ? "plane_" + plane->name : "map"; }

/// Lower corner, spacing and number of points of a plane or of the domain.
void lay_out(const Forest& forest, const PlaneCase* plane, const MapCase* map, Vec3& lower, Vec3& h,
             std::array<int, 3>& n) {
  const GridSize& g = forest.size();
  const int across = plane ? int(plane->normal[0] - 'x') : -1;
  for (int d = 0, along = 0; d < 3; ++d) {
    const double from = plane ? std::max(g.lower[d], plane->lower[d]) : g.lower[d],
                 to = plane ? std::min(g.upper[d], plane->upper[d]) : g.upper[d], fine = forest.finest_shape().h[d];
    if (d == across) {
      lower[d] = plane->at - 0.5 * fine, h[d] = fine, n[size_t(d)] = 1;
      continue;
    }
    if (plane && !(to > from)) throw InputError(fmt::format("{}: expected a plane inside the domain", plane->place));
    if (map)
      n[size_t(d)] = map->cells.empty() ? g.cells[size_t(d)] : map->cells[size_t(d)];
    else
      n[size_t(d)] =
          plane->cells.empty() ? std::max(1, int(std::lround((to - from) / fine))) : plane->cells[size_t(along)];
    ++along;
    lower[d] = from, h[d] = (to - from) / n[size_t(d)];
  }
  if (plane && (plane->at < g.lower[across] || plane->at > g.upper[across]))
    throw InputError(fmt::format("{}: expected a plane inside the domain", plane->place));
  if (const int64_t points = int64_t(n[0]) * n[1] * n[2]; points > most_points)
    throw InputError(fmt::format("{}: {} points; expected at most {}: give cells",
                                 plane ? plane->place : std::string("fluid.map"), points, most_points));
}

std::vector<Vec3> points_of(const Forest& forest, const PlaneCase* plane, const MapCase* map) {
  Vec3 lower, h;
  std::array<int, 3> n{1, 1, 1};
  lay_out(forest, plane, map, lower, h, n);
  std::vector<Vec3> points;
  points.reserve(size_t(n[0]) * size_t(n[1]) * size_t(n[2]));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) points.push_back(lower + Vec3{(i + 0.5) * h.x, (j + 0.5) * h.y, (k + 0.5) * h.z});
  return points;
}

}  // namespace

Raster::Raster(const Case& cs, const Forest& forest, const PlaneCase* plane, const MapCase* map)
    : case_(cs),
      maps_(!plane || plane->maps),
      values_(plane != nullptr),
      sampler_(points_of(forest, plane, map)),
      schedule_(plane ? plane->every : 0, Schedule::Zero::never),
      series_(cs.run.output.directory, stem_of(plane)) {
  lay_out(forest, plane, map, lower_, h_, n_);
  if (maps_) wave_.resize(sampler_.size()), mine_.assign(sampler_.size(), 0);
}

/// Waves follow their points to other ranks.
void Raster::fit(const Model& m) {
  if (maps_ && sampler_.fitted() && sampler_.outdated(m)) share_waves(m.forest.comm());
  if (!sampler_.fit(m)) return;
  calm_.assign(size_t(sampler_.groups()), {});
  if (!maps_) return;
  std::fill(mine_.begin(), mine_.end(), 0);
  for (int g = 0; g < sampler_.groups(); ++g) sampler_.each_point(g, [&](size_t i) { mine_[i] = 1; });
}

/// Afterwards every rank knows all of them.
void Raster::share_waves(const Comm& comm) {
  if (comm.size() == 1) return;
  static_assert(sizeof(Overpressure) % sizeof(double) == 0);
  for (size_t i = 0; i < wave_.size(); ++i)
    if (!mine_[i]) std::memset(static_cast<void*>(&wave_[i]), 0, sizeof(Overpressure));
  comm.sum(std::span(reinterpret_cast<double*>(wave_.data()), wave_.size() * sizeof(Overpressure) / sizeof(double)));
}

void Raster::step(const Model& m, double t0, double t1, double arrival) {
  if (!maps_) return;
  fit(m);
  const Gather gather(m.forest, m.state, m.setup.boundary, m.setup.medium);
  const auto at_rest = [&](int g) { return gather.quiet(sampler_.block_of(g)); };
  const auto state_of = [&](int g) { return m.state.info[size_t(sampler_.block_of(g))].U; };
  const auto unchanged = [&](int g) {
    const Calm& c = calm_[size_t(g)];
    return c.calm && at_rest(g) && std::equal(c.U, c.U + Cons::most, state_of(g));
  };
  std::vector<uint8_t> skipped(calm_.size());
  for (size_t g = 0; g < calm_.size(); ++g) skipped[g] = t0 >= 0 && unchanged(int(g));
  sampler_.sample(
      m, [&](int g) { return skipped[size_t(g)] != 0; },
      [&](size_t i, const FlowAt* flow) {
        Overpressure& w = wave_[i];
        if (t0 < 0)
          w.begin(flow ? flow->p : 0);
        else
          w.add(t0, t1, flow ? flow->p : w.p0, arrival > 0 ? arrival : 0.01 * w.p0);
      });
  for (size_t g = 0; g < calm_.size(); ++g) {
    if (skipped[g]) continue;
    bool calm = at_rest(int(g));
    sampler_.each_point(int(g), [&](size_t i) { calm = calm && wave_[i].now == 0; });
    calm_[g].calm = calm;
    std::copy_n(state_of(int(g)), int(Cons::most), calm_[g].U);
  }
}

void Raster::write_due(const Model& m, double t, bool last) {
  const bool due = schedule_.due(t);
  if ((due || last) && t != t_written_) write(m, t);
}

std::vector<VtkField> Raster::fields_of(const Model& m) {
  const size_t n = sampler_.size();
  std::vector<VtkField> fields;
  if (values_) {
    const size_t fractions = size_t(m.setup.medium.told_fractions()), width = 5 + fractions;
    std::vector<double> all(width * n);
    fit(m);
    sampler_.sample(
        m, [](int) { return false; },
        [&](size_t i, const FlowAt* flow) {
          const FlowAt w = flow ? *flow : FlowAt{};
          double* q = &all[width * i];
          q[0] = w.rho, q[1] = w.p, q[2] = w.v.x, q[3] = w.v.y, q[4] = w.v.z;
          std::copy_n(w.alpha, fractions, q + 5);
        });
    m.forest.comm().sum(all);
    frame_.rho.resize(n), frame_.p.resize(n), frame_.v.resize(n), frame_.alpha.assign(fractions, std::vector<double>(n));
    for (size_t i = 0; i < n; ++i) {
      const double* q = &all[width * i];
      frame_.rho[i] = q[0], frame_.p[i] = q[1], frame_.v[i] = {q[2], q[3], q[4]};
      for (size_t k = 0; k < fractions; ++k) frame_.alpha[k][i] = q[5 + k];
    }
    fields = {VtkField::scalars("density", frame_.rho), VtkField::scalars("pressure", frame_.p),
              VtkField::vectors("velocity", frame_.v)};
    for (size_t k = 0; k < fractions; ++k)
      fields.push_back(VtkField::scalars("alpha_" + case_.fluid.material[k].name, frame_.alpha[k]));
  }
  if (maps_) {
    share_waves(m.forest.comm());
    for (auto* f : {&frame_.peak, &frame_.impulse, &frame_.positive, &frame_.arrival, &frame_.duration}) f->resize(n);
    for (size_t i = 0; i < n; ++i) {
      const Overpressure& w = wave_[i];
      frame_.peak[i] = w.peak, frame_.impulse[i] = w.impulse, frame_.arrival[i] = w.arrival,
      frame_.duration[i] = w.duration();
      frame_.positive[i] = w.arrival >= 0 ? w.positive_impulse : 0;
    }
    for (VtkField& f : std::vector<VtkField>{
             VtkField::scalars("peak_overpressure", frame_.peak), VtkField::scalars("impulse", frame_.impulse),
             VtkField::scalars("positive_impulse", frame_.positive), VtkField::scalars("arrival_time", frame_.arrival),
             VtkField::scalars("positive_duration", frame_.duration)})
      fields.push_back(f);
  }
  for (VtkField& f : fields) f.exact = case_.run.output.exact;
  return fields;
}

void Raster::write(const Model& m, double t) {
  t_written_ = t;
  const std::vector<VtkField> fields = fields_of(m);
  if (m.forest.comm().root()) {
    VtkLevel level;
    level.spacing = h_;
    level.boxes = {{0, n_[0] - 1, 0, n_[1] - 1, 0, n_[2] - 1}};
    level.fields = fields;
    write_vtkhdf(series_.next_path(), lower_, {level});
  }
  series_.add(t, m.forest.comm());
}

void Raster::save(const Saved& to) {
  to.number("t_written", t_written_);
  if (!maps_) return;
  share_waves(to.comm());
  to.same("waves", wave_);
}

void Raster::restore(const Model& m, const Restored& from, double t) {
  t_written_ = from.number<double>("t_written");
  schedule_.skip_to(t);
  series_.resume(t);
  fit(m);
  if (maps_) wave_ = from.same<Overpressure>("waves");
}

}  // namespace bw::cfd
