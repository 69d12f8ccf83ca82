// SPDX-License-Identifier: Apache-2.0
#include "csd/energy.h"

#include <cmath>

#include "common/parallel/loop.h"
#include "csd/element/results.h"
#include "csd/physics.h"

namespace bw::csd {

double kinetic_energy(const State& s) {
  return parallel_sum(int64_t(s.x.size()),
                      [&](int64_t i) { return 0.5 * s.m[NodeId(i)] * dot(s.v[NodeId(i)], s.v[NodeId(i)]); });
}

double kinetic_product(const State& s, double short_dt) {
  return parallel_sum(int64_t(s.x.size()), [&](int64_t i) {
    const NodeId n(i);
    const double h = 0.5 * short_dt * s.local.steps_of(n);
    return s.m[n] > 0 ? 0.5 * s.m[n] * (dot(s.v[n], s.v[n]) - h * h / (s.m[n] * s.m[n]) * dot(s.f[n], s.f[n])) : 0.0;
  });
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
  const StoredEnergy stored = stored_energy(ph.elements, s);
  EnergyRow r;
  r.kinetic = kinetic_energy(s);
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
  r.residual = kinetic_product(s, s.short_dt) + r.elastic + r.plastic + r.filter + r.collapse + r.viscosity + r.cracks +
               r.rigidization + r.left - ph.energy.initial - r.external - r.conditions - r.mass_scaling;
  return r;
}

}  // namespace bw::csd
