// SPDX-License-Identifier: Apache-2.0
#include "csd/step.h"

#include <cmath>
#include <initializer_list>

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
  if (ph.rigid) ph.rigid->after_elements(ph.elements, s);
  if (ph.loads) ph.loads->add(mesh, t, s);  // eqs (15), (18)
}

/// Whose turn a condition is: springs pull like loads, ties hand forces on before the others take theirs, drag acts on
/// what these leave.
enum Turn { pulls, ties, holds, drags };
template <class C>
constexpr Turn turn(const C&) {
  if constexpr (requires { C::is_pull; }) return pulls;
  if constexpr (requires { C::is_tie; }) return ties;
  if constexpr (requires { C::is_last; }) return drags;
  return holds;
}
template <class Work>
void for_conditions(Model& m, std::initializer_list<Turn> turns, const Work& work) {
  for (const Turn now : turns)
    for (auto& kind : m.physics.conditions)
      std::visit(
          [&](auto& c) {
            if (turn(c) == now) work(c);
          },
          kind);
}
void on_force(Model& m, double dt) {
  for_conditions(m, {pulls, ties, holds, drags}, [&](auto& c) { c.on_force(m.state, dt); });
  if (m.physics.relaxation) m.physics.relaxation->on_force(m.state, dt);
  if (m.physics.rigid) m.physics.rigid->take_forces(m.state);
}
void before_drift(Model& m, double dt) {
  for_conditions(m, {pulls, holds, drags, ties},
                 [&](auto& c) { c.reaction.impulse = {}, c.before_drift(m.state, dt); });
}
void after_kick(Model& m, double dt) {
  for_conditions(m, {pulls, holds, drags, ties}, [&](auto& c) { c.after_kick(m.state, dt); });
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
  auto& rigid = m.physics.rigid;
  if (dt != s.dt) {  // the product form v^(n-1/2) v^(n+1/2) is conserved by steps of one length: book its jump
    if (const auto& ranks = m.physics.elements.ranks) ranks->complete(s);
    m.physics.energy.initial -= kinetic_product(s, s.dt) - kinetic_product(s, dt);
  }
  kick(s, 0.5 * dt);  // eq (14)
  if (rigid) rigid->kick(s, 0.5 * dt);
  before_drift(m, dt);
  if (m.physics.contact) m.physics.contact->act(m, dt);
  if (rigid) rigid->meet_walls(m.physics.conditions, s, dt);
  book_half_work(m, dt);
  drift(s, dt);
  if (rigid) rigid->drift(s, dt);
  sum_forces(m, s.t + dt, dt);
  on_force(m, dt);
  book_half_work(m, dt);
  kick(s, 0.5 * dt);  // eq (14)
  if (rigid) rigid->kick(s, 0.5 * dt);
  after_kick(m, dt);
  s.t += dt, s.dt = dt, s.step += 1;
  if (m.physics.cracks) m.physics.cracks->advance(m);  // sec. 3, eq (16)
  if (rigid) rigid->renew(m);
}

double stable_step(Model& m) {
  auto& [mesh, topology, s, ph] = m;
  double elements = ph.time_step.stable(ph.elements, s);
  if (std::isinf(elements) && ph.rigid) elements = ph.rigid->accurate_step();
  double omega2 = 0;  // of springs: frequencies of sums of stiffnesses are at most sums of squares
  for (const auto& kind : ph.conditions)
    std::visit(
        [&](const auto& c) {
          if constexpr (requires { c.omega2(s); }) omega2 += c.omega2(s);
        },
        kind);
  return omega2 > 0 ? 2 / std::sqrt(4 / (elements * elements) + omega2) : elements;
}

void change_given_forces(Model& m, std::vector<std::pair<Face, Vec3>> forces) {
  for (auto& kind : m.physics.conditions) std::visit([&](auto& c) { c.reaction.give_back(m.state); }, kind);
  if (m.physics.relaxation) m.physics.relaxation->reaction.give_back(m.state);
  m.physics.loads->replace_given(m.mesh, std::move(forces), m.state);
  on_force(m, 0);
}

}  // namespace bw::csd
