// SPDX-License-Identifier: Apache-2.0
#include "csd/step.h"

#include "csd/motion.h"

namespace bw::csd {
namespace {

/// s.f at s.x and time t; dt since the last call.
void sum_forces(Model& m, double t, double dt) {
  auto& [mesh, topology, s, ph] = m;
  MeanStress mean{.viscosity = ph.viscosity, .dt = dt};
  if (ph.filter) mean.given = &ph.filter->smooth(ph.elements, s);  // sec. 2.1
  const Reference reference{mesh.X, ph.resting};
  ph.energy.viscosity += internal_force(ph.elements, mean, s, &reference);  // eqs (1)-(13), (15)
  if (ph.loads) ph.loads->add(mesh, t, s);                                  // eqs (15), (18)
}

void on_force(Model& m, double dt) {
  for (auto& kind : m.physics.conditions) std::visit([&](auto& c) { c.on_force(m.state, dt); }, kind);
}
void before_drift(Model& m, double dt) {
  for (auto& kind : m.physics.conditions)
    std::visit([&](auto& c) { c.reaction.impulse = {}, c.before_drift(m.state, dt); }, kind);
}
void after_kick(Model& m, double dt) {
  for (auto& kind : m.physics.conditions) std::visit([&](auto& c) { c.after_kick(m.state, dt); }, kind);
}
/// Half a step's work of the loads, at the step's velocities.
void book_half_work(Model& m, double dt) {
  if (m.physics.loads) m.physics.energy.external += 0.5 * dt * m.physics.loads->power(m.state);
}

}  // namespace

void first_forces(Model& m) {
  sum_forces(m, m.state.t, 0);
  on_force(m, 0);
}

void step(Model& m, double dt) {
  auto& s = m.state;
  kick(s, 0.5 * dt);  // eq (14)
  before_drift(m, dt);
  book_half_work(m, dt);
  drift(s, dt);
  sum_forces(m, s.t + dt, dt);
  on_force(m, dt);
  book_half_work(m, dt);
  kick(s, 0.5 * dt);  // eq (14)
  after_kick(m, dt);
  s.t += dt, s.dt = dt, s.step += 1;
  if (m.physics.cracks) m.physics.cracks->advance(m);  // sec. 3, eq (16)
}

void change_given_forces(Model& m, std::vector<std::pair<Face, Vec3>> forces) {
  for (auto& kind : m.physics.conditions) std::visit([&](auto& c) { c.reaction.give_back(m.state); }, kind);
  m.physics.loads->replace_given(m.mesh, std::move(forces), m.state);
  on_force(m, 0);
}

}  // namespace bw::csd
