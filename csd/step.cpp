// SPDX-License-Identifier: Apache-2.0
#include "csd/step.h"

#include <cmath>
#include <initializer_list>

#include "csd/element/levels.h"
#include "csd/motion.h"

namespace bw::csd {
namespace {

/// s.f at s.x and time t of nodes that are due; dt: the shortest step since the last call.
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
  if (m.physics.rigid && m.state.local.all_due())
    m.physics.rigid->take_forces(m.physics.loads ? &*m.physics.loads : nullptr, m.state, dt * m.state.local.shortest());
}
void before_drift(Model& m, double dt) {
  for_conditions(m, {pulls, holds, drags, ties}, [&](auto& c) { c.before_drift(m.state, dt); });
}
void after_kick(Model& m, double dt) {
  for_conditions(m, {pulls, holds, drags, ties}, [&](auto& c) { c.after_kick(m.state, dt); });
}
/// Half a step's work of the loads, and the impulses that they keep books of, at the step's velocities.
void book_half_work(Model& m, double dt) {
  if (!m.physics.loads) return;
  double power = m.physics.loads->power(m.state);
  if (m.physics.rigid) power += m.physics.rigid->load_power(m.state);
  m.physics.energy.external += 0.5 * dt * power;
  m.physics.loads->book(m.mesh, m.state, 0.5 * dt);
}

/// The energy that moves with the length of the steps: the product form v^(n-1/2) v^(n+1/2) is conserved by steps of
/// one length.
template <class Change>
void book_jump(Model& m, double dt_before, double dt, const Change& change) {
  auto& s = m.state;
  if (m.physics.elements.ranks) m.physics.elements.ranks->complete(s);
  const Rigid* rigid = m.physics.rigid ? &*m.physics.rigid : nullptr;
  const double before = kinetic_product(s, dt_before, rigid);
  change();
  m.physics.energy.initial -= before - kinetic_product(s, dt, rigid);
}

/// From one time to the middle of the coming step and the places at its end, of nodes that are due. dt: the shortest
/// step, whole: the step of what moves by whole steps, 0 if that is under way.
void begin(Model& m, double dt, double whole) {
  auto& s = m.state;
  Rigid* rigid = whole > 0 && m.physics.rigid ? &*m.physics.rigid : nullptr;
  kick(s, 0.5 * dt);  // eq (14)
  if (rigid) rigid->begin_kick(s, 0.5 * whole);
  before_drift(m, dt);
  if (m.physics.contact) m.physics.contact->act(m, dt);
  if (rigid) rigid->meet_walls(m.physics.conditions, s, whole);
  book_half_work(m, dt);
  drift(s, dt);
  if (rigid) rigid->drift(s, whole);
}

/// From there to the step's end.
void end(Model& m, double dt, double whole) {
  auto& s = m.state;
  sum_forces(m, s.t + dt, dt);
  on_force(m, dt);
  book_half_work(m, dt);
  kick(s, 0.5 * dt);  // eq (14)
  if (whole > 0 && m.physics.rigid) m.physics.rigid->end_kick(s, 0.5 * whole);
  after_kick(m, dt);
  s.t += dt;
}

/// The levels that the last forces were summed up for.
void take_levels(Model& m, double dt) {
  auto& s = m.state;
  book_jump(m, dt, dt, [&] {
    s.local.take_next();
    take_next_sums(s);
    if (m.physics.rigid) m.physics.rigid->after_elements(m.physics.elements, s);
    if (auto& loads = m.physics.loads) {
      if (loads->radiation) loads->radiation->renew();
      loads->add(m.mesh, s.t, s);
    }
    on_force(m, 0);
  });
}

}  // namespace

void first_forces(Model& m) {
  sum_forces(m, m.state.t, 0);
  on_force(m, 0);
}

void step(Model& m, double dt) {
  auto& s = m.state;
  const int count = s.local.shortest();
  const double t_end = s.t + dt, short_dt = dt / count;
  if (short_dt != s.short_dt) book_jump(m, s.short_dt, short_dt, [] {});
  for_conditions(m, {pulls, holds, drags, ties}, [&](auto& c) { c.reaction.impulse = {}; });
  for (int i = 1; i <= count; ++i) {
    begin(m, short_dt, i == 1 ? dt : 0);
    s.local.set_now(i);
    end(m, short_dt, i == count ? dt : 0);
  }
  s.t = t_end, s.dt = dt, s.short_dt = short_dt, s.step += 1;
  if (s.local.is_pending()) take_levels(m, short_dt);
  if (m.physics.cracks) m.physics.cracks->advance(m);  // sec. 3, eq (16)
  if (m.physics.rigid) m.physics.rigid->renew(m);
}

double stable_step(Model& m) {
  State& s = m.state;
  Physics& ph = m.physics;
  double elements = ph.time_step.stable(ph.elements, s);
  if (s.local.most > 0 && ph.time_step.refreshed())
    s.local.propose(ph.elements.blocks, choose_levels(ph.elements, ph.time_step, s),
                    ph.rigid ? ph.rigid->is_rigid_node() : std::vector<char>{}, s.x.size());
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

void change_given_forces(Model& m, std::span<const Face> faces, std::vector<Vec3> forces) {
  for (auto& kind : m.physics.conditions) std::visit([&](auto& c) { c.reaction.give_back(m.state); }, kind);
  if (m.physics.relaxation) m.physics.relaxation->reaction.give_back(m.state);
  if (m.physics.rigid) m.physics.rigid->give_back(m.state);
  m.physics.loads->replace_given(m.mesh, faces, std::move(forces), m.state);
  on_force(m, 0);
}

}  // namespace bw::csd
