// SPDX-License-Identifier: Apache-2.0
#include "csd/coupled.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/app/error.h"
#include "common/app/log.h"
#include "common/app/timers.h"
#include "common/app/version.h"
#include "common/io/file.h"
#include "common/math/sum.h"
#include "common/parallel/loop.h"
#include "coupling/loads.h"
#include "csd/energy.h"
#include "csd/step.h"

namespace bw::csd {
namespace {

coupling::Hello hello_of(const Case& cs, const Model& m, const coupling::WetSurface& wet,
                         const coupling::CommitMark* mark) {
  coupling::Hello h;
  h.features = coupling::feature_checkpoint;
  if (mark) h.first_window = mark->window, h.restart_hash = mark->hash();
  h.program = "csd", h.version = version();
  h.t0 = m.state.t, h.t_end = cs.run.time.end;
  h.lower = {1e300, 1e300, 1e300}, h.upper = {-1e300, -1e300, -1e300};
  for (const Vec3& x : wet.x)
    for (int d = 0; d < 3; ++d) h.lower[d] = std::fmin(h.lower[d], x[d]), h.upper[d] = std::fmax(h.upper[d], x[d]);
  return h;
}

/// Of an element [kg].
double mass_of(const Model& m, ElemId e) {
  const double density = std::visit([](const auto& material) { return material.density; },
                                    m.physics.elements.materials[size_t(m.mesh.body[e])]);
  return density * m.state.V0[m.physics.elements.blocks.slot[e]];
}

/// The step that a run takes, over the stable one.
double step_share(const TimeStepCase& how, double dt_stable) {
  return how.fixed > 0 ? how.fixed / dt_stable : how.safety;
}

}  // namespace

void expect_fluid(const Case& cs, Model& m) {
  if (cs.solid.rigid && cs.solid.rigid->drag && cs.solid.rigid->drag->size == 0)
    throw InputError(fmt::format("{}: in a pair the size of a cell, a length > 0: the fluid pushes larger bodies",
                                 cs.solid.rigid->drag->place));
  if (!m.physics.loads) m.physics.loads.emplace(m.mesh, std::vector<LoadKind>{});
  if (cs.coupling.radiates()) m.physics.loads->radiation.emplace();
}

Coupled::Coupled(coupling::Channel& channel, const Case& cs, Model& m, const PairRestart* from)
    : case_(cs), surface_(m.mesh, m.topology, cs.solid.wet.faces, cs.solid.wet.place) {
  if (const auto& ranks = m.physics.elements.ranks) ranks->follow_all(m.state);
  surface_.update(m.mesh, m.topology, m.state.x, m.state.v);
  make_folder(cs.run.output.directory);
  side_ = std::make_unique<coupling::SolidSide>(channel, cs.coupling,
                                                hello_of(cs, m, surface_.wet(), from ? &from->mark : nullptr),
                                                cs.run.output.directory + "/coupling_history.csv");
  const RunControl::Checkpoint& rules = cs.run.checkpoint;
  if (!side_->fluid_keeps() && (rules.every > 0 || rules.every_wall > 0 || rules.every_steps > 0))
    channel.fail(coupling::exit_disagreement, "checkpoint: the fluid program can't keep its state");
  if (from) keep(Archive(from->file.file.section("model"), m.mesh, m.physics.elements).section("coupling"), m);
}

std::vector<Vec3> Coupled::positions(const Model& m) const {
  const std::vector<NodeId>& nodes = surface_.nodes();
  std::vector<Vec3> x(nodes.size());
  const auto take = [&](int64_t i) { x[size_t(i)] = m.state.x[nodes[size_t(i)]]; };
  parallel_for(int64_t(x.size()), take, worth_waking);
  return x;
}

void Coupled::keep(Archive a, Model& m) {
  surface_.update(m.mesh, m.topology, m.state.x, m.state.v);
  int64_t version = surface_.wet().topo_version;
  a.value("topo_version", version);
  if (case_.coupling.kind() == coupling::Scheme::concurrent) a.list("owed", owed_);
  surface_.go_on_from(version);
  side_->keep(a);
}

bool Coupled::can_commit() const {
  if (!side_->fluid_keeps()) warn("no checkpoint: the fluid program can't keep its state");
  return side_->fluid_keeps();
}

void Coupled::commit_with_next(const std::string& file, int keep) {
  const std::filesystem::path path = file;
  to_commit_.emplace();
  to_commit_->solid = path.filename().string(), to_commit_->folder = path.parent_path().string();
  marks_kept_ = keep;
  side_->ask_checkpoint();
}

double Coupled::exchange(Model& m, double dt_stable, double t_max) {
  if (to_commit_) to_commit_->window = side_->next_window(), to_commit_->t = m.state.t;
  std::vector<double> areal_mass;
  {
    const Timed timed("surface");
    surface_.update(m.mesh, m.topology, m.state.x, m.state.v);
    x_ = surface_.wet().x;
    area_ = coupling::area_vectors(surface_.wet());
    while (mass_.size() < area_.size()) mass_.push_back(mass_of(m, surface_.faces()[mass_.size()].elem));
    areal_mass.resize(area_.size());
    for (size_t f = 0; f < area_.size(); ++f) areal_mass[f] = mass_[f] / norm(area_[f]);
  }
  side_->send({.t0 = m.state.t, .t1_max = t_max, .dt_stable = dt_stable}, surface_.wet(), areal_mass);
  if (m.physics.loads->radiation) prepare_radiation();
  const std::optional<coupling::Loads> expected = side_->expect();
  const coupling::Loads& loads = expected ? *expected : side_->receive();
  if (!expected) hear();
  const Timed timed("surface");
  std::vector<Vec3> on_faces = coupling::face_forces(area_, loads, case_.coupling.reference_pressure);
  force_ = coupling::nodal_loads(surface_.wet(), on_faces);
  const double dt = loads.t1 - m.state.t;
  std::vector<Vec3> back = renew_radiation(m, loads, dt_stable, dt);
  if (!owed_.empty()) back.resize(on_faces.size());
  for (size_t i = 0; i < owed_.size(); ++i) back[i] += owed_[i] / dt;  // faces keep their places
  owed_.clear();
  if (expected) expected_ = Expected{on_faces, m.state.t, {}};
  back_ = back.empty() ? std::vector<Vec3>{} : coupling::nodal_loads(surface_.wet(), back);
  for (size_t i = 0; i < back.size(); ++i) on_faces[i] += back[i];
  change_given_forces(m, surface_.faces(), std::move(on_faces));
  return loads.t1;
}

void Coupled::hear() {
  if (to_commit_ && !side_->fluid_file().empty()) {  // the leader
    to_commit_->fluid = side_->fluid_file();
    coupling::commit(*to_commit_, marks_kept_);
    say("checkpoint of the pair at t = {:.6g} s", to_commit_->t);
  }
  to_commit_.reset();
}

void Coupled::settle() {
  const coupling::Loads& loads = side_->receive();
  hear();
  const double dt = loads.t1 - expected_->t0;
  std::vector<Vec3> lacking = coupling::face_forces(area_, loads, case_.coupling.reference_pressure);
  force_ = coupling::nodal_loads(surface_.wet(), lacking);
  for (size_t i = 0; i < lacking.size(); ++i) lacking[i] -= expected_->on_faces[i];
  const std::vector<Vec3>& start = surface_.wet().x;
  coupling::SolidTotals given = coupling::substep_totals(force_, start, start, x_, dt);
  given.substeps = expected_->beyond.substeps;
  side_->add(given);
  const coupling::SolidTotals missed =
      coupling::substep_totals(coupling::nodal_loads(surface_.wet(), lacking), start, start, x_, dt);
  side_->add_advance(expected_->beyond.impulse - missed.impulse, expected_->beyond.work - missed.work);
  owed_ = std::move(lacking);
  for (Vec3& force : owed_) force = force * dt;
  expected_.reset();
}

void Coupled::prepare_radiation() {
  const Timed timed("surface");
  const coupling::WetSurface& wet = surface_.wet();
  radiating_.face = surface_.faces();
  radiating_.n.assign(area_.size(), {}), radiating_.told.assign(area_.size(), 0.0);
  for (size_t f = 0; f < area_.size(); ++f) {
    const double size = norm(area_[f]);
    if (!(size > 0)) continue;
    radiating_.n[f] = area_[f] / size;
    radiating_.told[f] = dot(coupling::face_mean(wet.v, wet.quads[f]), radiating_.n[f]);
  }
}

std::vector<Vec3> Coupled::renew_radiation(Model& m, const coupling::Loads& loads, double dt_stable, double dt) {
  auto& radiation = m.physics.loads->radiation;
  if (!radiation) return {};
  std::vector<Vec3> back(area_.size());
  // faces keep their places; under box1 the fluid's walls jump to the solid, and nothing is repaid
  if (case_.coupling.kind() != coupling::Scheme::box1)
    for (size_t i = 0; i < radiation->impulses().size(); ++i) back[i] = radiation->impulses()[i] / -dt;
  radiating_.impedance = loads.impedance;
  radiating_.impedance.resize(area_.size());
  for (size_t f = 0; f < area_.size(); ++f) radiating_.impedance[f] *= norm(area_[f]);
  const double share = step_share(case_.solid.time_step, dt_stable);
  radiation->begin(m.mesh, m.state, std::move(radiating_), 1.8 * std::fmax(0, 1 - share * share));
  return back;
}

void Coupled::after_step(const Model& m, double dt) {
  if (expected_) side_->poll();  // a fluid that fails meanwhile waits a moment only to be heard
  const Timed timed("ledger");
  const std::vector<Vec3> before = std::move(x_);
  x_ = positions(m);
  if (!expected_) side_->add(coupling::substep_totals(force_, surface_.wet().x, before, x_, dt));
  coupling::SolidTotals back;
  back.substeps = 1;
  if (!back_.empty()) back = coupling::substep_totals(back_, surface_.wet().x, before, x_, dt);
  if (expected_)
    expected_->beyond += back;
  else
    side_->add_advance(back.impulse, back.work);
}

void Coupled::end_window(const Model& m) {
  if (expected_) settle();
  if (const auto& radiation = m.physics.loads->radiation) {
    ExactSum3 impulse;
    for (const Vec3& one : radiation->impulses()) impulse += one;
    side_->add_advance(impulse.value(), radiation->work());
  }
  side_->end_window(x_);
}

void Coupled::finish(const Model& m) {
  side_->tell_ledger(kinetic_energy(m.state));
  side_->finish();
}

}  // namespace bw::csd
