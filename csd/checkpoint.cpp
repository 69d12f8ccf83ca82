// SPDX-License-Identifier: Apache-2.0
#include "csd/checkpoint.h"

#include <fmt/format.h>

#include "common/app/log.h"
#include "common/app/timers.h"
#include "csd/archive.h"
#include "csd/coupled.h"
#include "csd/output.h"

namespace bw::csd {
namespace {

constexpr int64_t layout = 2;
constexpr const char* program = "solid";

Comm comm_of(const Model& m) { return m.physics.elements.ranks ? m.physics.elements.ranks->comm() : Comm(); }

void keep_state(Archive a, State& s) {
  a.value("t", s.t), a.value("dt", s.dt), a.value("dt_stable", s.dt_stable), a.value("step", s.step);
  a.value("short_dt", s.short_dt);
  Archive local = a.section("local_steps");
  s.local.keep(local);
  s.describe([&]<class T, class Index>(const char* name, Field<T, Index>& field, const char*, State::Use) {
    if constexpr (std::is_same_v<Index, NodeId>)
      a.list(name, field);
    else
      a.blocks(name, field, lanes);
  });
  a.blocks("stored_by_rigid", s.of_rigid, 1);
  for (size_t body = 0; body < s.history.size(); ++body)
    s.history[body].keep(a, fmt::format("history_{}", body), int(body));
}

void keep_condition(Archive a, ConditionKind& kind) {
  std::visit(
      [&](auto& c) {
        c.reaction.keep(a);
        if constexpr (requires { c.keep(a); }) c.keep(a);
      },
      kind);
}

/// All modules of the physics; those that a case lacks leave no trace.
void keep_physics(const Archive& all, Model& m) {
  Archive a = all.section("physics");
  Physics& ph = m.physics;
  a.list("mass_factor", ph.elements.mass_factor);
  a.value("energy", ph.energy);
  ph.resting.keep(a.section("resting"), ph.elements.blocks.block_count());
  const auto keep = [&](const char* name, auto& module) {
    Archive section = a.section(name);
    module.keep(section);
  };
  keep("time_step", ph.time_step);
  if (ph.filter) keep("filter", *ph.filter);
  if (ph.loads) keep("loads", *ph.loads);
  for (size_t i = 0; i < ph.conditions.size(); ++i)
    keep_condition(a.section(fmt::format("condition_{}", i)), ph.conditions[i]);
  if (ph.relaxation) keep("static", *ph.relaxation);
  if (ph.mass_scaling) keep("mass_scaling", *ph.mass_scaling);
  if (ph.cracks) keep("cracks", *ph.cracks);
  if (ph.rigid) keep("rigid", *ph.rigid);
  if (ph.contact) keep("contact", *ph.contact);
  if (!a.restores()) return;
  if (ph.rigid) ph.rigid->go_on(m);
  if (ph.contact) ph.contact->go_on(m);
}

void keep_run(Archive a, Progressed& run) {
  a.value("dt", run.dt);
  a.value("substeps", run.sub);
}

}  // namespace

std::optional<Restart> open_restart(const Case& cs, const std::string& file_or_folder, const Comm& comm) {
  if (file_or_folder.empty()) return {};
  CheckpointHead head{program, layout, case_hash(cs.file)};
  CheckpointReader file(find_checkpoint(file_or_folder, program), head, comm);
  say("goes on from step {}, t = {:.6g} s (written by {} rank{})", head.step, head.t, head.ranks,
      head.ranks == 1 ? "" : "s");
  return Restart{head, std::move(file)};
}

std::string write_checkpoint(const Case& cs, Model& m, const Progressed& run, Output& out, Coupled* coupled) {
  const Timed timed("checkpoint");
  const Comm comm = comm_of(m);
  complete(m);
  if (m.physics.rigid && m.physics.loads) m.physics.rigid->complete(*m.physics.loads);
  const std::string& folder = cs.run.output.directory;
  const std::string path = checkpoint_path(folder, program, m.state.step);
  CheckpointWriter file(path, {program, layout, case_hash(cs.file), m.state.step, m.state.t}, comm);
  const Saved mesh = file.section("mesh");
  mesh.same("hex", std::vector<std::array<NodeId, 8>>(m.mesh.hex.begin(), m.mesh.hex.end()));
  mesh.same("parent", std::vector<NodeId>(m.mesh.parent.begin(), m.mesh.parent.end()));
  const Archive all(file.section("model"), m.mesh, m.physics.elements);
  keep_state(all.section("state"), m.state);
  keep_physics(all, m);
  Progressed now = run;
  keep_run(all.section("run"), now);
  out.keep(all.section("output"));
  if (coupled) coupled->keep(all.section("coupling"), m);
  file.finish();
  return path;
}

void write_checkpoint_alone(const Case& cs, Model& m, const Progressed& run, Output& out, int keep) {
  write_checkpoint(cs, m, run, out, nullptr);
  if (comm_of(m).root()) drop_old_checkpoints(cs.run.output.directory, program, keep);
  say("checkpoint at step {}, t = {:.6g} s", m.state.step, m.state.t);
}

Progressed restore_model(Model& m, const Restart& from) {
  const Restored mesh = from.file.section("mesh");
  const auto hex = mesh.same<std::array<NodeId, 8>>("hex");
  const auto parent = mesh.same<NodeId>("parent");
  if (hex.size() != m.mesh.hex.size() || parent.size() < m.mesh.parent.size())
    throw InputError("the checkpoint doesn't fit the case's mesh");
  if (m.physics.cracks) m.physics.cracks->repeat(m, hex, parent);
  if (!std::equal(hex.begin(), hex.end(), m.mesh.hex.begin()))
    throw InputError("the checkpoint doesn't fit the case's mesh");
  const Archive all(from.file.section("model"), m.mesh, m.physics.elements);
  keep_state(all.section("state"), m.state);
  keep_physics(all, m);
  Progressed run;
  keep_run(all.section("run"), run);
  return run;
}

}  // namespace bw::csd
