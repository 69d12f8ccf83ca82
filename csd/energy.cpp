// SPDX-License-Identifier: Apache-2.0
#include "csd/energy.h"

#include <cmath>

#include "common/parallel/loop.h"
#include "csd/element/results.h"
#include "csd/physics.h"

namespace bw::csd {

namespace {

/// Sum of of_node over nodes of no rigid body and of of_body over these.
template <class OfNode, class OfBody>
auto sum_of_motion(const State& s, const Rigid* rigid, const OfNode& of_node, const OfBody& of_body) {
  using T = decltype(of_node(NodeId(0)));
  const auto add = [](const T& a, const T& b) { return a + b; };
  if (!rigid) return parallel_reduce(int64_t(s.x.size()), T{}, [&](int64_t n) { return of_node(NodeId(n)); }, add);
  const T of_free = parallel_reduce(
      rigid->free_count(s), T{}, [&](int64_t i) { return of_node(rigid->free_node(i)); }, add);
  const auto& bodies = rigid->bodies();
  return of_free + parallel_reduce(
                       int64_t(bodies.size()), T{}, [&](int64_t b) { return of_body(bodies[size_t(b)]); }, add);
}

}  // namespace

double kinetic_energy(const State& s, const Rigid* rigid) {
  return sum_of_motion(
      s, rigid, [&](NodeId n) { return 0.5 * s.m[n] * dot(s.v[n], s.v[n]); },
      [](const RigidBody& body) { return body.kinetic_energy(); });
}

double kinetic_product(const State& s, double short_dt, const Rigid* rigid) {
  const auto half_step = [&](NodeId n) { return 0.5 * short_dt * s.local.steps_of(n); };
  return sum_of_motion(
      s, rigid,
      [&](NodeId n) {
        const double h = half_step(n);
        return s.m[n] > 0 ? 0.5 * s.m[n] * (dot(s.v[n], s.v[n]) - h * h / (s.m[n] * s.m[n]) * dot(s.f[n], s.f[n]))
                          : 0.0;
      },
      [&](const RigidBody& body) { return body.kinetic_product(half_step(body.nodes().front())); });
}

Vec3 momentum_of(const State& s, const Rigid* rigid) {
  return sum_of_motion(
      s, rigid, [&](NodeId n) { return s.m[n] * s.v[n]; },
      [](const RigidBody& body) { return body.mass() * body.velocity(); });
}

double static_imbalance(const Physics& ph) {
  const auto squares = [](const auto& forces) {
    double sum = 0;
    for (const Vec3& f : forces) sum += dot(f, f);
    return sum;
  };
  double held = ph.loads ? squares(ph.loads->forces()) : 0;
  for (const auto& condition : ph.conditions)
    held += std::visit([&](const auto& c) { return squares(c.reaction.R); }, condition);
  return held > 0 ? std::sqrt(ph.relaxation->out_of_balance() / held) : 1;
}

EnergyRow energy_row(const Physics& ph, const State& s) {
  const Rigid* rigid = ph.rigid ? &*ph.rigid : nullptr;
  const StoredEnergy stored = stored_energy(ph.elements, s);
  EnergyRow r;
  r.kinetic = kinetic_energy(s, rigid);
  r.elastic = stored.elastic, r.plastic = stored.plastic, r.collapse = stored.collapse;
  r.heat = stored.heat, r.eqps_max = stored.eqps_max, r.temperature_max = stored.temperature_max;
  r.filter = ph.filter ? ph.filter->energy(ph.elements, s) : 0;
  r.viscosity = ph.energy.viscosity, r.external = ph.energy.external, r.cracks = ph.energy.cracks;
  r.rigidization = ph.energy.rigidization, r.left = ph.energy.left;
  for (const auto& condition : ph.conditions) {
    const double work = std::visit([](const auto& c) { return c.reaction.work; }, condition);
    r.conditions += work;
    if (std::holds_alternative<RigidWall>(condition)) r.contact += work;
    if (std::holds_alternative<Spring>(condition)) r.springs += work;
    if (std::holds_alternative<Damping>(condition)) r.damping += work;
  }
  if (ph.contact) r.conditions += ph.contact->work(), r.contact += ph.contact->work();
  if (ph.relaxation) r.conditions += ph.relaxation->reaction.work, r.damping += ph.relaxation->reaction.work;
  if (ph.rigid) r.conditions += ph.rigid->drag_work(), r.damping += ph.rigid->drag_work();
  if (ph.mass_scaling) r.mass_scaling = ph.mass_scaling->added_energy();
  r.residual = kinetic_product(s, s.short_dt, rigid) + r.elastic + r.plastic + r.filter + r.collapse + r.viscosity + r.cracks +
               r.rigidization + r.left - ph.energy.initial - r.external - r.conditions - r.mass_scaling;
  return r;
}

}  // namespace bw::csd
