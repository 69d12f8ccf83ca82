// SPDX-License-Identifier: Apache-2.0
#include "csd/step.h"

#include "csd/motion.h"

namespace bw::csd {
namespace {

/// s.f at s.x and time t; dt since the last call.
void all_forces(const Mesh& mesh, double t, double dt, State& s, Physics& ph) {
  MeanStress mean{.viscosity = ph.viscosity, .dt = dt};
  if (ph.filter) mean.given = &ph.filter->smooth(ph.elements, s);         // sec. 2.1
  ph.energy.viscosity += dt * internal_force(ph.elements, mean, s);       // eqs (1)-(13), (15)
  if (ph.loads) ph.loads->add(mesh, t, s);                                // eqs (15), (18)
}

}  // namespace

void first_forces(const Mesh& mesh, State& s, Physics& ph) {
  all_forces(mesh, s.t, 0, s, ph);
  for (auto& c : ph.conditions) std::visit([&](auto& condition) { condition.on_force(s, 0); }, c);
}

void step(Mesh& mesh, State& s, Physics& ph, double dt) {
  kick(s, 0.5 * dt);                                                      // eq (14)
  for (auto& c : ph.conditions) std::visit([&](auto& condition) { condition.before_drift(s, dt); }, c);
  if (ph.loads) ph.energy.external += 0.5 * dt * ph.loads->power(s);
  drift(s, dt);
  all_forces(mesh, s.t + dt, dt, s, ph);
  for (auto& c : ph.conditions) std::visit([&](auto& condition) { condition.on_force(s, dt); }, c);
  if (ph.loads) ph.energy.external += 0.5 * dt * ph.loads->power(s);
  kick(s, 0.5 * dt);                                                      // eq (14)
  for (auto& c : ph.conditions) std::visit([&](auto& condition) { condition.after_kick(s, dt); }, c);
  s.t += dt, s.dt = dt, s.step += 1;
}

}  // namespace bw::csd
