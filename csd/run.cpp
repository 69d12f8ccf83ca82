// SPDX-License-Identifier: Apache-2.0
#include "csd/run.h"

#include <fmt/format.h>

#include <cmath>

#include "common/app/checkpoint_clock.h"
#include "common/app/log.h"
#include "common/app/machine.h"
#include "common/app/timers.h"
#include "coupling/substeps.h"
#include "csd/checkpoint.h"
#include "csd/coupled.h"
#include "csd/output.h"
#include "csd/step.h"

namespace bw::csd {
namespace {

[[noreturn]] void fail(const Model& m, SlotId slot, const std::string& last_dump) {
  const ElemId e = m.physics.elements.blocks.elem[slot];
  struct {
    Vec3 c;
    double v;
  } at{{}, m.state.volume[slot]};
  for (NodeId n : m.mesh.hex[e]) at.c += 0.125 * m.state.x[n];
  if (const auto& ranks = m.physics.elements.ranks) at = ranks->from_owner(m.physics.elements.blocks, e, at);
  const auto& [c, v] = at;
  throw PhysicsError(fmt::format("element {} of body {} at ({:.6g}, {:.6g}, {:.6g}) m {}, step {}, t = {:.9g} s{}",
                                 m.mesh.elem_gid[e], m.mesh.body[e], c.x, c.y, c.z,
                                 std::isnan(v)
                                     ? "has positions that are not numbers"
                                     : fmt::format("is inverted (volume {:.3g} m^3 of {:.3g})", v, m.state.V0[slot]),
                                 m.state.step, m.state.t, last_dump.empty() ? "" : "; last good fields: " + last_dump));
}

/// The step that the case asks for at the present state. Steps that follow the bound up and down as things vibrate feed
/// the vibrations: it goes down with the bound at once, but up only where that gains something (T14).
double wanted_dt(const Case& cs, Model& m, const Output& out, double before) {
  constexpr double worth = 1.03;
  const TimeStepCase& how = cs.solid.time_step;
  m.state.dt_stable = stable_step(m);
  if (auto& scaling = m.physics.mass_scaling; scaling && !m.physics.time_step.inverted()) {
    scaling->enforce(m.mesh, m.physics.elements, m.physics.time_step, how.safety, m.state.dt_stable, m.state);
    m.state.dt_stable = stable_step(m);
  }
  if (const auto slot = m.physics.time_step.inverted()) fail(m, *slot, out.last_dump());
  const double bound = how.safety * m.state.dt_stable;
  const double dt = how.fixed > 0 ? how.fixed : bound > worth * before ? bound : std::fmin(bound, before);
  return how.maximum > 0 ? std::fmin(dt, how.maximum) : dt;
}

/// Not so far that the step could not grow meanwhile, and without slivers.
double target(double t, double next, double dt) { return next - t < 200 * dt ? next : t + 100 * dt; }

/// A run to static has arrived. Looked at now and then: the stored energy costs about a step.
bool is_at_rest(const Model& m) {
  const auto& relaxation = m.physics.relaxation;
  if (!relaxation || m.state.step % 20 != 0 || m.state.t < relaxation->input().loads_until) return false;
  const double tolerance = relaxation->input().tolerance;
  if (static_imbalance(m.physics) > tolerance) return false;
  const EnergyRow energy = energy_row(m.physics, m.state);
  return energy.kinetic <= tolerance * (energy.elastic + energy.plastic);
}

Comm comm_of(const Model& m) { return m.physics.elements.ranks ? m.physics.elements.ranks->comm() : Comm(); }

}  // namespace

int run(const Case& cs, Model& m, coupling::Channel* channel) {
  std::optional<coupling::CommitMark> mark;
  if (channel && !cs.restart.empty()) mark = coupling::find_commit(cs.restart);
  const std::optional<Restart> from = open_restart(cs, mark ? mark->solid_path() : cs.restart, comm_of(m));
  if (channel) expect_fluid(cs, m);
  Progressed now;
  if (from) now = restore_model(m, *from);
  if (channel && m.physics.rigid) m.physics.rigid->follow_all(m);
  std::optional<Coupled> coupled;
  if (channel) {
    const auto pair = from ? std::optional<PairRestart>({*from, *mark}) : std::nullopt;
    coupled.emplace(*channel, cs, m, pair ? &*pair : nullptr);
  }
  const double t_end = coupled ? coupled->t_end() : cs.run.time.end;
  const auto steps_left = [&] { return cs.run.time.max_steps == 0 || m.state.step < cs.run.time.max_steps; };
  Output out(cs, m, t_end, from ? &from->file : nullptr);
  CheckpointClock clock(cs.run.checkpoint, m.state.t, m.state.step);
  const auto checkpoint_due = [&] {
    const bool asked = coupled && coupled->checkpoint_asked();
    if (!clock.due(m.state.t, m.state.step, comm_of(m)) && !asked) return false;
    return !(coupled && !coupled->can_commit());
  };
  std::string status = "finished";
  try {
    double& dt = now.dt;
    if (!from) dt = wanted_dt(cs, m, out, 0);
    const auto& el = m.physics.elements;
    say("{} elements in {} colours, {}{} threads, first step {:.4g} s", m.mesh.elem_count(), el.blocks.colours.size(),
        el.ranks ? el.ranks->shares() : "", thread_count(), dt);
    out.write_due(m);
    bool at_rest = false;
    while (m.state.t < t_end && !at_rest && steps_left() && !(coupled && coupled->stop_asked())) {
      coupling::EqualSubsteps& sub = now.sub;
      if (sub.done()) {  // else a restored run goes on inside
        const double t_next = out.next_time(m.state.t);
        if (coupled && m.state.step > 0 && checkpoint_due())
          coupled->commit_with_next(write_checkpoint(cs, m, now, out, &*coupled), clock.keep());
        const double t_target =
            coupled ? coupled->exchange(m, m.state.dt_stable, t_next) : target(m.state.t, t_next, dt);
        sub = coupling::EqualSubsteps(m.state.t, t_target);
      }
      while (!sub.done() && !at_rest && (coupled || steps_left())) {
        const double h = sub.next(dt);
        step(m, h);
        m.state.t = sub.advance();
        if (coupled) coupled->after_step(m, h);
        dt = wanted_dt(cs, m, out, dt);
        out.write_due(m);
        out.tick(m);
        if (!coupled && checkpoint_due()) write_checkpoint_alone(cs, m, now, out, clock.keep());
        at_rest = is_at_rest(m);
      }
      if (coupled) coupled->end_window(m);
    }
    if (m.physics.relaxation)
      status = at_rest ? "converged" : "not converged";
    else if (m.state.t < t_end)
      status = coupled && coupled->stop_asked() ? "stopped by peer" : "max_steps";
    if (coupled) coupled->finish(m);
  } catch (const PhysicsError& e) {
    out.finish(m, "failed", e.what());
    throw;
  }
  if (status == "not converged")
    warn("no static solution yet: forces out of balance are {:.2g} of the loads", static_imbalance(m.physics));
  out.finish(m, status, "");
  return exit_ok;
}

void check(const Case& cs, Model& m) {
  const TimeStepCase& how = cs.solid.time_step;
  const double stable = stable_step(m);
  double dt = how.fixed > 0 ? how.fixed : how.safety * stable;
  if (how.maximum > 0) dt = std::fmin(dt, how.maximum);
  const double steps = cs.run.time.end / dt, elements = m.mesh.elem_count();
  constexpr double elements_a_second = 4e6;  // of one thread, plastic (run/bench solid)
  say("{}: the case is sound", cs.file);
  say("{:.0f} elements, about {:.0f} steps of {:.3g} s, {:.2f} GB, {:.1f} min on {} threads; elements that flatten "
      "take more steps",
      elements, steps, dt, 1e-9 * double(peak_memory()), steps * elements / (elements_a_second * thread_count()) / 60,
      thread_count());
}

}  // namespace bw::csd
