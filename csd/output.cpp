// SPDX-License-Identifier: Apache-2.0
#include "csd/output.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "common/app/log.h"
#include "common/app/machine.h"
#include "common/app/summary.h"
#include "common/io/file.h"
#include "common/parallel/loop.h"
#include "csd/element/results.h"

namespace bw::csd {
namespace {

bool any_heats(const Elements& el) {
  for (int body = 0; body < int(el.materials.size()); ++body)
    if (heats(el, body)) return true;
  return false;
}

std::vector<History::Column> history_columns(std::vector<ProbeCase>& probes, const Physics& ph) {
  std::vector<History::Column> c{{"t", "s"}, {"step", "1"}, {"dt", "s"}, {"dt_stable", "s"}};
  for (const char* name : {"kinetic_energy", "elastic_energy", "plastic_work", "filter_energy", "collapse_energy",
                           "viscous_work", "external_work", "condition_work", "contact_work", "spring_work",
                           "damping_work", "crack_energy", "mass_scaling_energy", "energy_residual"})
    c.push_back({name, "J"});
  c.push_back({"mass", "kg"});
  c.push_back({"added_mass", "kg"});
  for (const char* name : {"momentum x", "momentum y", "momentum z"}) c.push_back({name, "kg m/s"});
  for (const char* name : {"eqps_max", "checkerboard", "collapsed", "nodes", "opened_faces", "fragments"})
    c.push_back({name, "1"});
  if (ph.rigid) c.push_back({"rigidization_energy", "J"}), c.push_back({"rigid_fragments", "1"});
  if (ph.rigid && ph.rigid->left()) {
    c.push_back({"left_fragments", "1"}), c.push_back({"left_mass", "kg"}), c.push_back({"left_energy", "J"});
    for (const char* name : {"left_momentum x", "left_momentum y", "left_momentum z"}) c.push_back({name, "kg m/s"});
  }
  if (any_heats(ph.elements)) c.push_back({"heat", "J"}), c.push_back({"temperature_max", "K"});
  if (ph.relaxation) c.push_back({"static_imbalance", "1"}), c.push_back({"relaxation_rate", "1/s"});
  for (ProbeCase& probe : probes)
    std::visit(
        [&](const auto& p) {
          for (const auto& column : p.columns()) c.push_back({probe.name + " " + column.name, column.unit});
        },
        probe.kind);
  return c;
}

double mass_of(const State& s) {
  return parallel_sum(int64_t(s.x.size()), [&](int64_t n) { return s.m[NodeId(n)]; });
}
double collapsed_elements(const Model& m) {
  return sum_elements(m.physics.elements, [&](SlotId slot) { return m.state.collapsed[slot]; });
}
/// While it lives, nodes that touch another body show the velocity with which they have moved in the last step. Theirs
/// at its end lacks half of the coming step's impulse of contact, a fair part of the velocity where waves pass.
class TouchingMove {
 public:
  explicit TouchingMove(Model& m) : s_(m.state) {
    if (!m.physics.contact) return;
    for (const NodeId n : m.physics.contact->pushed()) {
      kept_.emplace_back(n, s_.v[n]);
      s_.v[n] -= (0.5 * s_.dt / s_.m[n]) * s_.f[n];
    }
  }
  ~TouchingMove() {
    for (const auto& [n, v] : kept_) s_.v[n] = v;
  }
  TouchingMove(const TouchingMove&) = delete;
  TouchingMove& operator=(const TouchingMove&) = delete;

 private:
  State& s_;
  std::vector<std::pair<NodeId, Vec3>> kept_;
};
double piece_count(const Mesh& mesh) {
  const auto piece = pieces_by_nodes(mesh);
  return double(parallel_sum(mesh.elem_count(), [&](int64_t e) { return piece[ElemId(e)] == ElemId(e) ? 1.0 : 0.0; }));
}
bool writes(const Model& m) { return !m.physics.elements.ranks || m.physics.elements.ranks->comm().root(); }

}  // namespace

Output::Output(const Case& cs, const Model& model, double t_end, const CheckpointReader* from)
    : case_(cs),
      t_end_(t_end),
      probes_(cs.solid.probes),
      series_(cs.run.output.directory, "solid"),
      fields_(cs.run.output.fields_every, Schedule::Zero::never),
      rows_(cs.run.output.history_every, Schedule::Zero::every_step),
      progress_(t_end, cs.run.time.max_steps),
      watch_(cs.solid.energy),
      start_(std::chrono::steady_clock::now()) {
  make_folder(cs.run.output.directory);
  if (!model.physics.cracks) pieces_ = piece_count(model.mesh);
  for (ProbeCase& probe : probes_) std::visit([&](auto& p) { p.select(model.mesh, model.physics); }, probe.kind);
  const auto columns = history_columns(probes_, model.physics);
  if (from) keep(Archive(from->section("model"), model.mesh, model.physics.elements).section("output"));
  if (!writes(model)) return;
  const std::string path = cs.run.output.directory + "/solid_history.csv";
  history_.emplace(from ? History::resume_rows(path, columns, rows_written_) : History(path, columns));
}

void Output::keep(Archive a) {
  if (history_) {
    history_->flush();
    rows_written_ = history_->rows();
  }
  a.value("rows", rows_written_);
  a.value("t_row", t_row_), a.value("t_fields", t_fields_);
  a.value("energy", energy_), a.value("mass", mass_), a.value("collapsed", collapsed_), a.value("momentum", momentum_);
  a.value("checkerboard", checkerboard_);
  watch_.keep(a);
  a.value("element_steps", all_element_steps_), a.value("short_steps", short_steps_);
  if (!a.restores()) return;
  fields_.skip_to(t_fields_), rows_.skip_to(t_row_);
  series_.resume(t_fields_);
}

double Output::next_time(double t) const {
  double next = std::fmin(t_end_, rows_.next_time(t));
  for (double other : {fields_.next_time(t), t_end_})  // multiples that differ by round-off are one time
    next = other < next * (1 - 1e-12) ? other : other < next * (1 + 1e-12) ? std::fmax(next, other) : next;
  return std::fmin(next, t_end_);
}

/// Nodal fields are right everywhere, once for each time at which something is written.
void Output::complete(Model& m) {
  if (m.state.t == t_complete_) return;
  t_complete_ = m.state.t;
  csd::complete(m);
}

void Output::write_due(Model& model) {
  if (rows_.due(model.state.t)) write_row(model);
  if (fields_.due(model.state.t)) write_fields(model);
}

void Output::write_row(Model& m) {
  State& s = m.state;
  if (s.t == t_row_) return;
  t_row_ = s.t;
  if (m.physics.elements.ranks) m.physics.elements.ranks->complete(s);
  if (!probes_.empty()) complete(m);
  energy_ = energy_row(m.physics, s);
  mass_ = mass_of(s), momentum_ = momentum_of(s, m.physics.rigid ? &*m.physics.rigid : nullptr);
  const double chi = raw_.of(m.physics.elements, s);
  std::vector<double> row{s.t,
                          double(s.step),
                          s.dt,
                          s.dt_stable,
                          energy_.kinetic,
                          energy_.elastic,
                          energy_.plastic,
                          energy_.filter,
                          energy_.collapse,
                          energy_.viscosity,
                          energy_.external,
                          energy_.conditions,
                          energy_.contact,
                          energy_.springs,
                          energy_.damping,
                          energy_.cracks,
                          energy_.mass_scaling,
                          energy_.residual,
                          mass_,
                          m.physics.mass_scaling ? m.physics.mass_scaling->added_mass() : 0,
                          momentum_.x,
                          momentum_.y,
                          momentum_.z,
                          energy_.eqps_max,
                          chi,
                          collapsed_ = collapsed_elements(m),
                          double(m.mesh.node_count())};
  auto& cracks = m.physics.cracks;
  row.push_back(cracks ? double(cracks->opened_faces()) : 0);
  row.push_back(cracks ? double(cracks->fragments(m).count()) : pieces_);
  if (const auto& rigid = m.physics.rigid)
    row.push_back(energy_.rigidization), row.push_back(double(rigid->bodies().size()));
  if (const auto* left = m.physics.rigid ? m.physics.rigid->left() : nullptr)
    row.insert(row.end(),
               {double(left->count), left->mass, energy_.left, left->momentum.x, left->momentum.y, left->momentum.z});
  if (any_heats(m.physics.elements)) row.push_back(energy_.heat), row.push_back(energy_.temperature_max);
  if (const auto& relaxation = m.physics.relaxation)
    row.push_back(static_imbalance(m.physics)), row.push_back(relaxation->rate());
  {
    const TouchingMove shown(m);
    for (ProbeCase& probe : probes_) std::visit([&](auto& p) { p.values(m.mesh, s, m.physics, row); }, probe.kind);
  }
  if (history_) history_->row(row);
  if (checkerboard_.warns(chi, s.step))
    warn("the checkerboard of the volumes grows: indicator {:.2f} at step {}, t = {:.6g} s; a weaker filter, or none",
         checkerboard_.mean(), s.step, s.t);
  watch_.check(energy_, m);
}

std::string Output::write_fields(Model& m) {
  const State& s = m.state;
  if (s.t == t_fields_) return last_dump_;
  t_fields_ = s.t;
  complete(m);
  const auto& blocks = m.physics.elements.blocks;
  const size_t n = size_t(m.mesh.elem_count());
  const auto* sigma_m = m.physics.filter ? m.physics.filter->mean_stress() : nullptr;
  std::vector<double> J(n), mean(n), mises(n), eqps(n), eqps_max(n), temperature(n);
  parallel_for(int64_t(n), [&](int64_t i) {
    const SlotId slot = blocks.slot[ElemId(i)];
    if (!blocks.is_own(slot)) return;
    const ElementResult r = evaluate(m.physics.elements, s, slot, sigma_m);
    const size_t e = size_t(i);
    J[e] = s.volume[slot] / s.V0[slot], mean[e] = trace(r.sigma) / 3, mises[e] = von_mises(r.sigma), eqps[e] = r.eqps,
    eqps_max[e] = r.eqps_max, temperature[e] = r.temperature;
  });
  if (const auto& ranks = m.physics.elements.ranks)
    for (auto* values : {&J, &mean, &mises, &eqps, &eqps_max, &temperature}) ranks->complete(*values);
  VtkMesh mesh;
  mesh.points = {s.x.data(), s.x.size()};
  mesh.add_hexahedra(m.mesh.hex);
  std::vector<VtkField> cells{VtkField::scalars("J", J),
                              VtkField::scalars("sigma_m", mean),
                              VtkField::scalars("von_mises", mises),
                              VtkField::scalars("eqps", eqps),
                              VtkField::scalars("eqps_max", eqps_max),
                              VtkField::integers("body", std::span<const int32_t>(m.mesh.body.data(), n)),
                              VtkField::integers("gid", std::span<const int64_t>(m.mesh.elem_gid.data(), n))};
  if (any_heats(m.physics.elements)) cells.push_back(VtkField::scalars("temperature", temperature));
  std::vector<int64_t> frag_id;
  std::vector<double> fail;
  if (auto& cracks = m.physics.cracks) {
    const Fragments& fragments = cracks->fragments(m);
    for (int32_t label : fragments.label()) frag_id.push_back(fragments.id(label));
    fail = cracks->fail();
    if (const auto& ranks = m.physics.elements.ranks) ranks->complete(fail);
    cells.push_back(VtkField::scalars("fail", fail));
    cells.push_back(VtkField::integers("frag_id", frag_id));
    if (const Pieces* pieces = cracks->pieces())
      cells.push_back(VtkField::integers("bin", std::span<const int32_t>(pieces->bins().data(), n)));
  }
  if (!writes(m)) return "";
  last_dump_ = series_.next_path();
  const TouchingMove shown(m);
  std::vector<VtkField> points{VtkField::vectors("velocity", {s.v.data(), s.v.size()}),
                               VtkField::vectors("X", {m.mesh.X.data(), m.mesh.X.size()})};
  for (auto* fields : {&cells, &points})
    for (VtkField& field : *fields) field.exact = case_.run.output.exact;
  write_vtkhdf(last_dump_, mesh, points, cells);
  series_.add(s.t);
  return last_dump_;
}

void Output::write_fragment_table(Model& m) {
  complete(m);
  const Elements& el = m.physics.elements;
  const bool is_hot = any_heats(el);
  std::vector<double> eqps(size_t(m.mesh.elem_count())), temperature(is_hot ? eqps.size() : 0);
  parallel_for(int64_t(eqps.size()), [&](int64_t e) {
    const SlotId slot = el.blocks.slot[ElemId(e)];
    if (!el.blocks.is_own(slot)) return;
    eqps[size_t(e)] = mean_eqps(el, m.state, slot);
    if (is_hot) temperature[size_t(e)] = evaluate(el, m.state, slot).temperature;
  });
  if (el.ranks) el.ranks->complete(eqps);
  if (el.ranks && is_hot) el.ranks->complete(temperature);
  FragmentFields fields{m.state.x, m.state.v, m.state.m, eqps, temperature, {}};
  if (m.physics.rigid) fields.is_rigid = m.physics.rigid->is_rigid_node();
  const Fragments& fragments = m.physics.rigid ? m.physics.rigid->fragments(m) : m.physics.cracks->fragments(m);
  auto table = fragments.table(m.mesh, m.topology, fields);
  if (m.physics.rigid) m.physics.rigid->add_left(m, table);
  if (!writes(m)) return;
  write_fragments(case_.run.output.directory + "/fragments", m.state.t, table);
  if (const Pieces* pieces = m.physics.cracks ? m.physics.cracks->pieces() : nullptr)
    write_rows(case_.run.output.directory + "/pieces.csv", pieces->rows());
}

std::string Output::limiter(const Model& m) const {
  const SlotId slot = m.physics.time_step.limiting();
  return slot.valid() ? fmt::format("elem {}", m.mesh.elem_gid[m.physics.elements.blocks.elem[slot]]) : "";
}

double Output::rate() const {
  return element_steps_ / std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Output::tick(Model& m) {
  element_steps_ += m.mesh.elem_count() * m.state.local.evaluations();
  all_element_steps_ += m.mesh.elem_count() * m.state.local.evaluations();
  short_steps_ += m.state.local.shortest();
  const auto now = std::chrono::steady_clock::now();
  if (const double seconds = std::chrono::duration<double>(now - window_.start).count(); seconds > 0.25) {
    window_.best = std::max(window_.best, (element_steps_ - window_.element_steps) / seconds);
    window_.element_steps = element_steps_, window_.start = now;
  }
  if (watch_.is_auditing() && m.physics.rigid) m.physics.rigid->complete(m.state);
  watch_.tick(m);
  progress_.tick(m.state.step, m.state.t, [&] {
    return fmt::format("dt {:.3g} s ({}), energy residual {:.1e}, {} nodes, {:.2f} Melem/s", m.state.dt, limiter(m),
                       std::copysign(watch_.part(), energy_.residual), m.mesh.node_count(), 1e-6 * rate());
  });
}

void Output::finish(Model& m, const std::string& status, const std::string& message) {
  const double loop_rate = rate();
  progress_.finish();
  const bool failed = status == "failed";
  if (!failed) {
    write_row(m);
    if (case_.run.output.fields_every > 0) write_fields(m);
  }
  if (history_) history_->flush();
  if ((m.physics.cracks || m.physics.rigid) && !failed) write_fragment_table(m);
  Summary sum;
  sum.case_file = case_.file, sum.title = case_.run.title, sum.status = status, sum.message = message;
  const auto& ranks = m.physics.elements.ranks;
  sum.ranks = ranks ? ranks->comm().size() : 1;
  sum.threads = thread_count(), sum.steps = m.state.step, sum.t = m.state.t;
  sum.rates = {{"elements_per_second", loop_rate}};
  if (window_.best > 0) sum.rates.emplace_back("best_elements_per_second", window_.best);
  sum.energies = {{"kinetic", energy_.kinetic},           {"elastic", energy_.elastic},
                  {"plastic", energy_.plastic},           {"filter", energy_.filter},
                  {"collapse", energy_.collapse},         {"viscosity", energy_.viscosity},
                  {"external", energy_.external},         {"conditions", energy_.conditions},
                  {"contact", energy_.contact},           {"springs", energy_.springs},
                  {"damping", energy_.damping},           {"cracks", energy_.cracks},
                  {"mass_scaling", energy_.mass_scaling}, {"residual", energy_.residual}};
  sum.masses = {{"solid", mass_}};
  if (m.physics.mass_scaling) sum.masses.emplace_back("added", m.physics.mass_scaling->added_mass());
  sum.momenta = {{"x", momentum_.x}, {"y", momentum_.y}, {"z", momentum_.z}};
  sum.counts = {{"elements", double(m.mesh.elem_count())},
                {"nodes", double(m.mesh.node_count())},
                {"collapsed_elements", collapsed_}};
  if (m.state.local.most > 0) {
    sum.counts.emplace_back("short_steps", double(short_steps_));
    sum.counts.emplace_back("element_steps", all_element_steps_);
  }
  if (m.physics.resting.skips) sum.counts.emplace_back("skipped_blocks", double(m.physics.resting.skips));
  if (m.physics.cracks) {
    sum.counts.emplace_back("opened_faces", double(m.physics.cracks->opened_faces()));
    sum.counts.emplace_back("fragments", double(m.physics.cracks->fragments(m).count()));
  }
  if (m.physics.contact) sum.counts.emplace_back("contact_impulses", double(m.physics.contact->impulses()));
  if (const auto& rigid = m.physics.rigid) {
    sum.energies.emplace_back("rigidization", energy_.rigidization);
    sum.counts.emplace_back("rigid_fragments", double(rigid->bodies().size()));
    if (const auto* left = rigid->left()) {
      sum.counts.emplace_back("left_fragments", double(left->count));
      sum.energies.emplace_back("left", energy_.left);
      sum.masses.emplace_back("left", left->mass);
    }
    sum.counts.emplace_back("rigid_elements", double(rigid->elements()));
    sum.counts.emplace_back("skipped_rigid_blocks", double(m.physics.resting.rigid_skips));
  }
  sum.values = {{"energy_residual_part", watch_.worst()},
                {"dt", m.state.dt},
                {"dt_stable", m.state.dt_stable},
                {"eqps_max", energy_.eqps_max}};
  if (any_heats(m.physics.elements)) {
    sum.energies.emplace_back("heat", energy_.heat);
    sum.values.emplace_back("temperature_max", energy_.temperature_max);
  }
  if (m.physics.relaxation) sum.values.emplace_back("static_imbalance", static_imbalance(m.physics));
  if (ranks && !failed)
    sum.values.emplace_back("exchange_share",
                            ranks->comm().sum(timers().seconds("exchange") / timers().wall()) / sum.ranks);
  if (writes(m)) sum.write(case_.run.output.directory + "/solid_summary.json", timers());
  say("{}: {} steps to t = {:.6g} s, {:.2f} Melem-steps/s (best {:.2f}), dt limited by {}, energy residual {:.2e} J",
      status, m.state.step, m.state.t, 1e-6 * loop_rate, 1e-6 * std::max(window_.best, loop_rate), limiter(m),
      energy_.residual);
}

}  // namespace bw::csd
