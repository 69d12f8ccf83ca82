// SPDX-License-Identifier: Apache-2.0
#include "cfd/run.h"

#include <fmt/format.h>

#include <cmath>

#include "cfd/checkpoint.h"
#include "cfd/output.h"
#include "cfd/remarks.h"
#include "cfd/start/paint.h"
#include "cfd/window_steps.h"
#include "common/app/log.h"
#include "common/app/timers.h"
#include "common/app/version.h"
#include "common/parallel/loop.h"
#include "coupling/commit.h"
#include "coupling/fluid_side.h"
#include "coupling/wall_path.h"

namespace bw::cfd {
namespace {

class BodyMotion final : public WallMotion {
 public:
  explicit BodyMotion(Bodies& bodies) : bodies_(bodies), surface_(bodies.at(0)) {}
  void go_to(double t) { t_ = t, surface_ = bodies_.at(t); }
  const coupling::WetSurface& surface() const override { return surface_; }
  std::vector<Vec3> x() const override { return surface_.x; }
  std::vector<Vec3> velocity(double dt) const override {
    std::vector<Vec3> v = bodies_.positions(t_, dt);
    for (size_t i = 0; i < v.size(); ++i) v[i] = (v[i] - surface_.x[i]) / dt;
    return v;
  }
  std::vector<Vec3> x_end(double dt) const override { return bodies_.positions(t_, dt); }

 private:
  Bodies& bodies_;
  coupling::WetSurface surface_;
  double t_ = 0;
};

class SolidMotion final : public WallMotion {
 public:
  explicit SolidMotion(const coupling::FluidSide& side) : side_(side) {}
  void begin() { path_.begin(side_.window(), side_.surface()); }
  void end(double dt) { path_.end(dt); }
  coupling::WallPath& path() { return path_; }
  const coupling::WetSurface& surface() const override { return side_.surface(); }
  std::vector<Vec3> x() const override { return path_.x(); }
  std::vector<Vec3> velocity(double dt) const override { return path_.velocity(dt); }
  std::vector<Vec3> x_end(double dt) const override { return path_.x_end(dt); }

 private:
  const coupling::FluidSide& side_;
  coupling::WallPath path_;
};

double courant_step(const Case& cs, const Model& m, const Sweep& sweep) {
  const double rate = sweep.max_rate(m.state);
  return rate > 0 ? cs.fluid.scheme.cfl / rate : 1e300;
}
/// No gas has a larger rho c [kg/(m^2 s)]: the densest cell's rho and the fastest one's rate.
double largest_impedance(const Model& m, const Sweep& sweep) {
  double rho = 0, h = 1e300;
  for (int b = 0; b < m.forest.local_blocks(); ++b)
    for (size_t c = 0; c < size_t(m.forest.shape(b).cells()); ++c) {
      double U[Cons::most];
      for (int q = 0; q < m.state.rows(); ++q) U[q] = m.state.block(b, q)[c];
      rho = std::max(rho, m.setup.medium.density(U));
    }
  for (int d = 0; d < 3; ++d)
    if (m.forest.shape().used[size_t(d)]) h = std::min(h, m.forest.shape().h[d]);
  return m.forest.comm().max(rho) * h * sweep.max_rate(m.state);
}
/// The step towards `next`: whole, or in equal parts, so that no sliver is left.
double step_towards(double t, double next, double dt) {
  const double left = next - t;
  return left / std::ceil(left / dt * (1 - 1e-12));
}

/// Cells of the domain if all were of the finest level.
double finest_cells(const Model& m) {
  const Index3 n = m.forest.cells_of_level(m.forest.levels());
  return double(n[0]) * n[1] * n[2];
}

void open_model(Model& m, const Case& cs, Books& books, const Restart* from = nullptr) {
  if (!from) paint(m, cs);
  books.fit(m);
  if (from) restore_books(books, m.forest.comm(), *from);
  std::vector<int> all;
  for (int b = 0; b < m.forest.local_blocks(); ++b) all.push_back(b);
  books.refresh(m, all);
  const FluidSums s = books.sums(m);
  if (m.setup.burn && !from) m.explosive_mass = s.U[Cons::arho1];
  if (!from) remark(cs, m, s);
  if (m.refine)
    say("levels 0 to {} of cells; {} cells at the start, {:.2g} of them if all were of the finest level", m.forest.levels(), m.forest.global_cells(),
        double(m.forest.global_cells()) / finest_cells(m));
  say("{} x {} x {} cells of {:.4g} x {:.4g} x {:.4g} m in {} blocks of {} x {} x {}, {} threads", m.forest.size().cells[0],
      m.forest.size().cells[1], m.forest.size().cells[2], m.forest.shape().h.x, m.forest.shape().h.y, m.forest.shape().h.z,
      m.forest.global_blocks(), m.forest.shape().n[0], m.forest.shape().n[1], m.forest.shape().n[2], thread_count());
  if (m.explosive_mass > 0) say("{:.6g} kg of {} ({:.6g} J to be released)", m.explosive_mass, m.setup.medium.names[0], m.setup.burn->q * m.explosive_mass);
}

int run_alone(const Case& cs, Model& m) {
  const std::optional<Restart> from = open_restart(cs, cs.restart, m.forest.comm());
  std::optional<BodyMotion> motion;
  if (!cs.fluid.body.empty()) {
    const BlockShape& s = m.forest.finest_shape();
    double h = 1e300;
    for (int d = 0; d < 3; ++d)
      if (s.used[size_t(d)]) h = std::min(h, s.h[d]);
    m.bodies.emplace(cs.fluid.body, ShapeSetting{cs.fluid.grid.lower, cs.fluid.grid.upper, h, s.used});
    if (from && !m.bodies->free().empty()) m.bodies->restore(from->file.section("bodies"));
    motion.emplace(*m.bodies);
    add_walls(m, cs.coupling.reference_pressure);
    if (from) motion->go_to(from->head.t);
    if (!from) m.walls->begin(motion->surface(), motion->x(), std::vector<Vec3>(motion->x().size()));
  }
  if (from) restore_model(m, *from, motion ? &motion->surface() : nullptr);
  Books books(m);
  open_model(m, cs, books, from ? &*from : nullptr);
  if (!from && cs.fluid.start_from && cs.fluid.start_from->keep_time) m.state.t = m.start->profile.t;
  Sweep sweep(m.forest, m.setup, m.walls ? &*m.walls : nullptr);
  if (m.bodies && !m.bodies->free().empty() && !from) m.bodies->begin(largest_impedance(m, sweep));
  std::optional<Restored> written;
  if (from) written.emplace(from->file.section("output"));
  Output out(cs, m, cs.run.time.end, written ? &*written : nullptr);
  CheckpointClock clock(cs.run.checkpoint, m.state.t, m.state.step);
  out.write_due(m, books);
  const double t_end = cs.run.time.end;
  const auto steps_left = [&] { return cs.run.time.max_steps == 0 || m.state.step < cs.run.time.max_steps; };
  try {
    while (m.state.t < t_end && steps_left()) {
      const double t0 = m.state.t, next = out.next_time(t0), most = m.bodies ? m.bodies->largest_step() : 1e300,
                   wanted = step_towards(t0, next, std::min(courant_step(cs, m, sweep), most));
      if (motion) motion->go_to(t0);
      coupling::Loads loads;
      const double dt = step(m, sweep, books, wanted, motion ? &*motion : nullptr, true, &loads);
      if (motion) m.bodies->advance(dt, loads, cs.coupling.reference_pressure, m.walls->conservative() ? &m.walls->face_forces() : nullptr);
      m.state.t = dt == wanted && wanted >= next - t0 ? next : t0 + dt;  // assigned, not summed: no drift
      out.write_due(m, books);
      out.tick(m, dt, sweep.stepped());
      if (clock.due(m.state.t, m.state.step, m.forest.comm())) write_checkpoint_alone(cs, m, books, out, clock.keep());
    }
  } catch (const PhysicsError& e) {
    out.finish(m, books, "failed", e.what());
    throw;
  }
  out.finish(m, books, m.state.t < t_end ? "max_steps" : "finished", "");
  if (m.forest.shape().radial()) write_profile(cs.run.output.directory + "/fluid_profile.h5", m);
  return exit_ok;
}

coupling::FluidTotals totals_of(const Model& m, const Books& books) {
  coupling::FluidTotals t;
  const FluidSums s = books.sums(m);
  t.mass = m.setup.medium.density(s.U);
  t.energy = s.U[Cons::rhoE];
  t.momentum = {s.U[Cons::mom], s.U[Cons::mom_y], s.U[Cons::mom_z]};
  const SweptSums swept = books.swept_sums(m.forest.comm());
  t.mass_covered = swept.mass_lost, t.mass_uncovered = swept.mass_made;
  t.energy_covered = swept.energy_lost, t.energy_uncovered = swept.energy_made;
  return t;
}

/// The fluid leads: it takes one step towards the solid's limit and tells the solid how far it came.
int run_coupled(const Case& cs, Model& m, coupling::Channel& channel) {
  if (cs.fluid.scheme.interface == "sharp")
    throw InputError(fmt::format("{}: expected \"smooth\" in a coupled run: walls reconstruct by lines", cs.fluid.scheme.place));
  if (cs.fluid.walls.treatment == "cut_cell")
    throw InputError(fmt::format("{}: expected another treatment than \"cut_cell\" in a coupled run: a solid's surface cracks and gets thinner than two cells", cs.fluid.walls.place));
  if (!cs.fluid.body.empty()) throw InputError(fmt::format("{}: fluid.body: bodies are for runs of cfd alone; the solid program gives the surface here", cs.file));
  std::optional<coupling::CommitMark> mark;
  if (!cs.restart.empty()) mark = coupling::find_commit(cs.restart);
  const std::optional<Restart> from = open_restart(cs, mark ? mark->fluid_path() : "", m.forest.comm());
  coupling::Hello hello;
  hello.program = "cfd", hello.version = version();
  hello.features = coupling::feature_checkpoint | (m.wall_options.conservative ? uint64_t(coupling::feature_traction) : 0);
  if (mark) hello.first_window = mark->window, hello.restart_hash = mark->hash(), hello.t0 = from->head.t;
  hello.t_end = cs.run.time.end;
  hello.lower = cs.fluid.grid.lower, hello.upper = cs.fluid.grid.upper;
  for (int d = 0; d < 3; ++d)
    if (cs.fluid.grid.cells[size_t(d)] == 1) hello.lower[d] = -1e300, hello.upper[d] = 1e300;  // the flow is the same all along
  coupling::FluidSide side(channel, cs.coupling, hello);
  SolidMotion motion(side);
  add_walls(m, cs.coupling.reference_pressure);
  Books books(m);
  std::optional<Sweep> sweep;
  std::optional<Output> out;
  const auto begin = [&] {
    open_model(m, cs, books, from ? &*from : nullptr);
    sweep.emplace(m.forest, m.setup, &*m.walls);
    std::optional<Restored> written;
    if (from) written.emplace(from->file.section("output"));
    out.emplace(cs, m, side.t_end(), written ? &*written : nullptr);
    out->write_due(m, books);
  };
  if (from) {
    const coupling::WetSurface surface = restore_surface(*from, motion.path());
    restore_model(m, *from, &surface);
    begin();
  }
  CheckpointClock signal({}, m.state.t, m.state.step);  // when else a checkpoint is due the solid knows
  const auto receive = [&] {
    Timed timed("waiting for the solid", Timed::waiting);
    return side.receive();
  };
  try {
    while (receive()) {
      const auto keep = [&] {
        if (!side.window().checkpoint) return;
        side.kept(write_checkpoint(cs, m, books, *out, &motion.path()));
        signal.due(m.state.t, m.state.step, m.forest.comm());  // the solid got it as well
      };
      const bool is_first = !out;
      if (!is_first) keep();
      motion.begin();
      if (is_first) {
        m.walls->begin(side.surface(), motion.x(), side.surface().v);
        begin();
        keep();
      }
      const coupling::Window window = side.window();
      m.state.t = window.t0;
      const auto wanted = [&](double t, double next) { return step_towards(t, next, courant_step(cs, m, *sweep)); };
      const auto [stepped, dt] = window_steps(m, *sweep, books, motion, window, wanted, [&](double t) { return out->next_time(t); },
                                              [&] { out->write_due(m, books); });
      coupling::Loads loads = stepped;
      if (window.fixed || cs.coupling.kind() == coupling::Scheme::concurrent) loads.dt_next = courant_step(cs, m, *sweep);
      const int64_t dry = loads.totals.dry_faces;
      const double dry_area = loads.totals.dry_area;
      loads.totals = totals_of(m, books);
      const coupling::FluidTotals at_faces = coupling::wall_totals(side.surface(), loads, motion.velocity(dt), window);
      loads.totals.impulse = at_faces.impulse, loads.totals.moment = at_faces.moment;
      loads.totals.work = at_faces.work, loads.totals.swept = at_faces.swept;
      loads.totals.dry_faces = dry, loads.totals.dry_area = dry_area;
      loads.checkpoint = signal.due(m.state.t, m.state.step, m.forest.comm());
      side.send(loads);
      motion.end(dt);
      out->write_due(m, books);
      out->tick(m, dt, sweep->stepped());
    }
  } catch (const PhysicsError& e) {
    if (out) out->finish(m, books, "failed", e.what());
    throw;
  }
  if (out) out->finish(m, books, "finished", "");
  return exit_ok;
}

}  // namespace

int run(const Case& cs, const Comm& comm, coupling::Channel* channel) {
  if (channel && cs.fluid.grid.geometry != Geometry::planar)
    throw InputError(fmt::format("{}: fluid.geometry: expected \"planar\" in a coupled run; start it from a run along a radius with [fluid.start_from]", cs.file));
  if (channel && cs.fluid.start_from && cs.fluid.start_from->keep_time)
    throw InputError(fmt::format("{}: expected keep_time = false in a coupled run, which begins at 0", cs.fluid.start_from->place));
  Model m(comm, cs);
  return channel ? run_coupled(cs, m, *channel) : run_alone(cs, m);
}

void check(const Case& cs, const Comm& comm) {
  Model m(comm, cs);
  double fastest = 0;
  for (const EosChoice& eos : m.setup.medium.eos)
    if (m.setup.burn && std::holds_alternative<Jwl>(eos)) fastest = std::max(fastest, 2 * m.setup.burn->c_CJ);
  for (const RegionCase& r : cs.fluid.region) {
    const auto& eos = m.setup.medium.eos[cs.fluid.material_index(r.material, r.place)];
    std::visit(
        [&](const auto& e) {
          double rho = r.density;
          if constexpr (requires { e.rho0; }) rho = r.unburnt ? e.rho0 : rho;
          fastest = std::max(fastest, sound_speed(e, rho, r.pressure) + norm(r.velocity));
        },
        eos);
  }
  double rate = 0;
  for (int d = 0; d < 3; ++d)
    if (m.forest.shape().used[size_t(d)]) rate += fastest / m.forest.finest_shape().h[d];
  const double steps = rate > 0 ? cs.run.time.end * rate / cs.fluid.scheme.cfl : 0;
  const double cells = finest_cells(m);
  const double bytes_a_cell = 2 * 8 * m.state.rows() + 1, cells_a_second = 6e6;
  say("{}: the case is sound", cs.file);
  say("about {:.0f} steps of {:.3g} s, {:.2f} GB, at most {:.1f} min on {} threads (blocks at rest cost nothing{})", steps, cs.run.time.end / std::max(steps, 1.0),
      1e-9 * cells * bytes_a_cell, steps * cells / (cells_a_second * thread_count()) / 60, thread_count(), m.refine ? "; if all blocks were of the finest level" : "");
}

}  // namespace bw::cfd
