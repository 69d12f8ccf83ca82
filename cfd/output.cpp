// SPDX-License-Identifier: Apache-2.0
#include "cfd/output.h"

#include <fmt/format.h>

#include <cmath>

#include "common/app/log.h"
#include "common/app/machine.h"
#include "common/app/summary.h"
#include "common/io/file.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

std::vector<History::Column> history_columns(const Case& cs) {
  std::vector<History::Column> c{{"t", "s"}, {"step", "1"}, {"dt", "s"}};
  for (const MaterialCase& m : cs.fluid.material) c.push_back({"mass " + m.name, "kg"});
  c.push_back({"mass", "kg"});
  for (const char* name : {"momentum x", "momentum y", "momentum z"}) c.push_back({name, "kg m/s"});
  for (const char* name : {"energy", "stored_energy"}) c.push_back({name, "J"});
  c.push_back({"volume", "m^3"});
  c.push_back({"p_max", "Pa"});
  c.push_back({"outflow mass", "kg"});
  for (const char* name : {"outflow momentum x", "outflow momentum y", "outflow momentum z"}) c.push_back({name, "N s"});
  c.push_back({"outflow energy", "J"});
  for (const char* name : {"wall impulse x", "wall impulse y", "wall impulse z", "face impulse x", "face impulse y", "face impulse z",
                           "lip impulse x", "lip impulse y", "lip impulse z"})
    c.push_back({name, "N s"});
  for (const char* name : {"wall energy", "face work"}) c.push_back({name, "J"});
  c.push_back({"wall mass", "kg"});
  for (const char* name : {"covered mass", "uncovered mass", "cleaned mass"}) c.push_back({name, "kg"});
  for (const char* name : {"covered energy", "uncovered energy", "cleaned energy", "floor energy"}) c.push_back({name, "J"});
  for (const char* name : {"swept momentum x", "swept momentum y", "swept momentum z"}) c.push_back({name, "N s"});
  for (const char* name : {"cells covered", "cells fresh", "floors", "scaled", "first_order", "repeated_steps", "active_share"}) c.push_back({name, "1"});
  if (cs.fluid.afterburn) c.push_back({"afterburn energy", "J"}), c.push_back({"afterburnt", "1"});
  return c;
}

std::vector<History::Column> free_body_columns() {
  std::vector<History::Column> c{{"t", "s"}};
  const auto vector = [&](const char* name, const char* unit) {
    for (const char* axis : {" x", " y", " z"}) c.push_back({std::string(name) + axis, unit});
  };
  vector("centre", "m"), vector("velocity", "m/s"), vector("spin", "1/s"), vector("turn axis", "1");
  c.push_back({"turn angle", "1"});
  vector("force", "N"), vector("moment", "N m"), vector("impulse", "N s"), vector("angular momentum", "kg m^2/s");
  c.push_back({"kinetic energy", "J"}), c.push_back({"work", "J"});
  return c;
}

}  // namespace

double stored_energy(const Model& m) {
  if (!m.setup.burn) return 0;
  const Burn& burn = *m.setup.burn;
  std::vector<double> part(size_t(m.forest.local_blocks()));
  parallel_for_dynamic(m.forest.local_blocks(), [&](int64_t b) {
    if (m.state.info[size_t(b)].material >= 2) return;
    const BlockShape& s = m.forest.shape(int(b));
    const Vec3 lower = m.forest.lower(int(b));
    if (burn.phase(lower, lower + m.forest.extent(int(b)), m.state.t, m.state.t) == Burn::Phase::after) return;
    const std::vector<uint8_t> blocked = blocked_cells(m, int(b));
    const double* arho = m.state.block(int(b), Cons::arho1);
    double sum = 0;
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          const size_t cell = s.at(k, j, i);
          if (!(arho[cell] > 0) || (!blocked.empty() && blocked[cell])) continue;
          sum += arho[cell] * burn.stored(lower + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z}, m.state.t) *
                 s.cell_volume(lower.x, i);
        }
    part[size_t(b)] = sum;
  });
  double total = 0;
  for (double p : m.forest.comm().size() == 1 ? part : m.forest.comm().gather_all(part)) total += p;
  return total;
}

Output::Output(const Case& cs, const Model& m, double t_end, const Restored* from)
    : case_(cs),
      t_end_(t_end),
      root_(m.forest.comm().root()),
      folder_(cs.run.output.directory),
      records_(cs, m, from == nullptr),
      series_(cs.run.output.directory, "fluid"),
      fields_(cs.run.output.fields_every, Schedule::Zero::never),
      rows_(cs.run.output.history_every, Schedule::Zero::every_step),
      progress_(t_end, cs.run.time.max_steps),
      start_(std::chrono::steady_clock::now()) {
  if (from) {
    restore(m, *from);
  } else if (root_) {
    history_.emplace(cs.run.output.directory + "/fluid_history.csv", history_columns(cs));
    open_free_bodies(m, nullptr);
  }
}

void Output::open_free_bodies(const Model& m, const int64_t* rows) {
  if (!root_ || !m.bodies) return;
  for (const FreeBody& f : m.bodies->free()) {
    const std::string path = fmt::format("{}/fluid_body_{}.csv", case_.run.output.directory, f.name);
    if (rows)
      free_bodies_.push_back(History::resume_rows(path, free_body_columns(), *rows));
    else
      free_bodies_.emplace_back(path, free_body_columns());
  }
}

void Output::write_free_bodies(const Model& m) {
  for (size_t i = 0; i < free_bodies_.size(); ++i) {
    const RigidBody& b = m.bodies->free()[i].rigid;
    const RigidBody::State& s = b.state();
    const double half = norm(s.place.turn.u), angle = 2 * std::atan2(half, s.place.turn.w);
    std::vector<double> row{m.state.t};
    const auto add = [&](const Vec3& v) {
      for (int d = 0; d < 3; ++d) row.push_back(v[d]);
    };
    add(b.centre()), add(b.velocity()), add(b.spin()), add(half > 0 ? s.place.turn.u / half : Vec3{0, 0, 1});
    row.push_back(angle);
    add(s.force), add(s.moment), add(s.impulse), add(b.angular_momentum());
    row.push_back(b.kinetic_energy()), row.push_back(s.work);
    free_bodies_[i].row(row);
  }
}

void Output::save(const Saved& to) {
  if (history_) history_->flush();
  to.number("rows", history_ ? history_->rows() : int64_t(0));
  for (History& table : free_bodies_) table.flush();
  to.number("body_rows", free_bodies_.empty() ? int64_t(0) : free_bodies_[0].rows());
  to.same("numbers", std::vector<double>{dt_, t_row_, t_fields_, active_share_, p_max_});
  to.same("sums", std::vector<FluidSums>{first_, last_});
  records_.save(to.section("records"));
}

void Output::restore(const Model& m, const Restored& from) {
  const int64_t rows = from.number<int64_t>("rows");
  if (root_) history_.emplace(History::resume_rows(case_.run.output.directory + "/fluid_history.csv", history_columns(case_), rows));
  const int64_t body_rows = from.has("body_rows") ? from.number<int64_t>("body_rows") : 0;
  open_free_bodies(m, &body_rows);
  const std::vector<double> n = from.same<double>("numbers");
  dt_ = n.at(0), t_row_ = n.at(1), t_fields_ = n.at(2), active_share_ = n.at(3), p_max_ = n.at(4);
  const std::vector<FluidSums> sums = from.same<FluidSums>("sums");
  first_ = sums.at(0), last_ = sums.at(1);
  rows_.skip_to(m.state.t);
  fields_.skip_to(m.state.t);
  series_.resume(m.state.t);
  records_.restore(m, from.section("records"), m.state.t);
  updates_before_ = updates(m);
}

FlowAt Output::at(const Model& m, const Vec3& x) const {
  const Forest::Cell c = m.forest.find(x);
  double values[5 + most_materials] = {};
  if (c.block >= 0) {
    double U[Cons::most], W[Prim::most];
    const size_t cell = m.forest.shape().at(c.k, c.j, c.i);
    for (int q = 0; q < m.state.rows(); ++q) U[q] = m.state.block(c.block, q)[cell];
    std::visit([&](const auto& pair) { pair.to_primitive(U, W, m.setup.medium.floors); }, m.setup.medium.mixture);
    values[0] = m.setup.medium.density(U), values[1] = W[Prim::p];
    for (int d = 0; d < 3; ++d) values[2 + d] = W[Prim::v + d];
    for (int k = 0; k < std::max(1, m.setup.medium.told_fractions()); ++k) values[5 + k] = W[Prim::alpha(k)];
  }
  if (m.forest.comm().size() > 1) m.forest.comm().sum(values);
  FlowAt w{values[0], values[1], {values[2], values[3], values[4]}};
  std::copy_n(values + 5, int(most_materials), w.alpha);
  return w;
}

double Output::next_time(double t) const {
  double next = t_end_;
  for (const double other : {rows_.next_time(t), fields_.next_time(t)})  // multiples that differ by round-off are one time
    if (other < next * (1 - 1e-12)) next = other;
  return next;
}

void Output::write_due(Model& m, const Books& books) {
  records_.step(m);
  if (rows_.due(m.state.t)) write_row(m, books);
  if (fields_.due(m.state.t)) {
    write_fields(m);
    write_lines(m);
  }
}

void Output::write_row(const Model& m, const Books& books) {
  if (m.state.t == t_row_) return;
  const FluidSums s = books.sums(m);
  if (t_row_ < 0) first_ = s;
  t_row_ = m.state.t;
  last_ = s;
  const Booked b = books.booked(m);
  const auto out = [&](int q) {
    double sum = 0;
    for (int d = 0; d < 3; ++d) sum += b.side[2 * d + 1][q] - b.side[2 * d][q];
    return sum;
  };
  swept_ = books.swept_sums(m.forest.comm());
  std::vector<double> row{m.state.t, double(m.state.step), dt_};
  for (size_t i = 0; i < case_.fluid.material.size(); ++i) row.push_back(s.U[Cons::arho(int(i))]);
  row.push_back(m.setup.medium.density(s.U));
  for (int d = 0; d < 3; ++d) row.push_back(s.U[Cons::mom + d]);
  row.push_back(s.U[Cons::rhoE]);
  row.push_back(stored_energy(m));
  row.push_back(s.volume);
  row.push_back(p_max_ = books.p_max(m));
  double mass_out = out(0) + out(1);
  for (int k = 2; k < m.setup.medium.count(); ++k) mass_out += out(Cons::arho(k));
  row.push_back(mass_out);
  for (int d = 0; d < 3; ++d) row.push_back(out(Cons::mom + d));
  row.push_back(out(Cons::rhoE));
  for (const Vec3& v : {books.wall_impulse, books.face_impulse, books.lip_impulse})
    for (int d = 0; d < 3; ++d) row.push_back(v[d]);
  for (double v : {books.wall_energy, books.face_work, books.wall_mass, swept_.mass_lost, swept_.mass_made, m.setup.medium.density(b.cleaned), swept_.energy_lost, swept_.energy_made, b.cleaned[Cons::rhoE], b.floor_energy,
                   swept_.momentum.x, swept_.momentum.y, swept_.momentum.z,
                   double(swept_.covered), double(swept_.fresh), double(b.floors), double(b.scaled_cells), double(b.first_order), double(books.repeated), active_share_})
    row.push_back(v);
  if (m.setup.afterburn) row.push_back(b.afterburn), row.push_back(m.setup.afterburn->share);
  if (history_) history_->row(row);
  write_free_bodies(m);
}

void Output::write_fields(const Model& m) {
  if (m.state.t == t_fields_) return;
  t_fields_ = m.state.t;
  write_field_file(series_.next_path(), case_, m);
  series_.add(m.state.t, m.forest.comm());
}

void Output::write_lines(const Model& m) {
  for (const LineCase& line : case_.fluid.line) {
    const BlockShape& s = m.forest.finest_shape();
    const Vec3 along = line.to - line.from;
    double cells = 0;
    for (int d = 0; d < 3; ++d)
      if (s.used[size_t(d)]) cells = std::max(cells, std::abs(along[d]) / s.h[d]);
    const int n = std::max(1, int(std::lround(cells)));
    std::optional<History> table;
    std::vector<History::Column> columns{{"x", "m"}, {"y", "m"}, {"z", "m"}, {"density", "kg/m^3"}, {"vx", "m/s"}, {"vy", "m/s"}, {"vz", "m/s"},
                                         {"pressure", "Pa"}, {"alpha1", "1"}, {"t", "s"}};
    const int fractions = m.setup.medium.told_fractions();
    for (int k = 1; k < fractions; ++k) columns.push_back({fmt::format("alpha{}", k + 1), "1"});
    if (root_) table.emplace(fmt::format("{}/fluid_line_{}.csv", case_.run.output.directory, line.name), columns);
    for (int i = 0; i < n; ++i) {
      const Vec3 x = line.from + ((i + 0.5) / n) * along;
      const FlowAt w = at(m, x);
      std::vector<double> row{x.x, x.y, x.z, w.rho, w.v.x, w.v.y, w.v.z, w.p, w.alpha[0], m.state.t};
      if (fractions > 1) row.insert(row.end(), w.alpha + 1, w.alpha + fractions);
      if (table) table->row(row);
    }
  }
}

double Output::updates(const Model& m) const {
  double n = 0;
  for (const Booked& b : m.state.booked) n += double(b.updates);
  return m.forest.comm().sum(n);
}

void Output::tick(const Model& m, double dt, size_t active_blocks) {
  dt_ = dt;
  active_share_ = m.forest.comm().sum(double(active_blocks)) / double(m.forest.global_blocks());
  progress_.tick(m.state.step, m.state.t, [&] {
    double n = 0;
    for (const Booked& b : m.state.booked) n += double(b.updates);
    n -= updates_before_ / m.forest.comm().size();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return fmt::format("dt {:.3g} s, {:.0f} % active, {:.2f} Mcells/s", dt, 100 * active_share_, 1e-6 * n / seconds);
  });
}

void Output::finish(Model& m, const Books& books, const std::string& status, const std::string& message) {
  progress_.finish();
  if (status != "failed") {
    records_.finish(m);
    write_row(m, books);
    if (case_.run.output.fields_every > 0) write_fields(m);
    write_lines(m);
  }
  records_.write_summary();
  Summary s;
  s.case_file = case_.file, s.title = case_.run.title, s.status = status, s.message = message;
  s.ranks = m.forest.comm().size(), s.threads = thread_count();
  s.steps = m.state.step, s.t = m.state.t;
  const double n = status == "failed" ? 0 : updates(m);
  const double flow = timers().seconds("flow");
  s.rates = {{"cell_updates_per_second", (n - updates_before_) / std::max(flow, 1e-9)}, {"cell_updates", n}};
  s.masses = {{"start", m.setup.medium.density(first_.U)}, {"end", m.setup.medium.density(last_.U)}, {"explosive", m.explosive_mass},
              {"cavity_volume_times_density", m.cavity_mass}, {"covered", swept_.mass_lost},
              {"uncovered", swept_.mass_made}, {"through_walls", books.wall_mass}};
  s.energies = {{"start", first_.U[Cons::rhoE]}, {"end", last_.U[Cons::rhoE]}, {"chemical", m.setup.burn ? m.setup.burn->q * m.explosive_mass : 0},
                {"wall", books.wall_energy}, {"face_work", books.face_work}, {"covered", swept_.energy_lost},
                {"uncovered", swept_.energy_made}};
  s.momenta = {{"x", last_.U[Cons::mom]}, {"y", last_.U[Cons::mom_y]}, {"z", last_.U[Cons::mom_z]}};
  const auto add = [&](const char* name, const Vec3& v) {
    for (int d = 0; d < 3; ++d) s.momenta.push_back({fmt::format("{} {}", name, "xyz"[d]), v[d]});
  };
  add("wall impulse", books.wall_impulse);
  add("face impulse", books.face_impulse);
  if (m.bodies && !m.bodies->free().empty()) {
    Vec3 momentum;
    double kinetic = 0, work = 0;
    for (const FreeBody& f : m.bodies->free())
      momentum += f.rigid.mass().mass * f.rigid.velocity(), kinetic += f.rigid.kinetic_energy(), work += f.rigid.state().work;
    add("free bodies", momentum);
    s.energies.push_back({"free_bodies_kinetic", kinetic}), s.energies.push_back({"free_bodies_work", work});
  }
  if (status != "failed") {
    const Booked b = books.booked(m);
    if (m.setup.afterburn) s.energies.push_back({"afterburn", b.afterburn});
    s.counts = {{"floors", double(b.floors)}, {"scaled_cells", double(b.scaled_cells)}, {"first_order_cells", double(b.first_order)}};
  }
  s.counts.push_back({"repeated_steps", double(books.repeated)});
  s.counts.push_back({"cells", double(m.forest.global_cells())});
  s.counts.push_back({"blocks", double(m.forest.global_blocks())});
  s.values = {{"p_max", p_max_}, {"active_share", active_share_}};
  if (m.refine) {
    const double regrid = timers().seconds("regrid");
    s.values.push_back({"levels_share", (books.seconds_between_levels + regrid) / std::max(flow + regrid, 1e-9)});
    s.values.push_back({"regrid_share", regrid / std::max(flow + regrid, 1e-9)});
  }
  if (root_) {
    s.write(case_.run.output.directory + "/fluid_summary.json", timers());
    say("{}: step {}, t = {:.6g} s, {:.2f} Mcell-updates/s in the flow", status, m.state.step, m.state.t, 1e-6 * (n - updates_before_) / std::max(flow, 1e-9));
  }
}

}  // namespace bw::cfd
