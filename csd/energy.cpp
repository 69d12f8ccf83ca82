// SPDX-License-Identifier: Apache-2.0
#include "csd/energy.h"

#include "common/parallel/loop.h"
#include "csd/element/results.h"
#include "csd/physics.h"

namespace bw::csd {

double kinetic_energy(const State& s) {
  return parallel_sum(int64_t(s.x.size()),
                      [&](int64_t i) { return 0.5 * s.m[NodeId(i)] * dot(s.v[NodeId(i)], s.v[NodeId(i)]); });
}

double kinetic_product(const State& s) {
  const double h = 0.5 * s.dt;
  return parallel_sum(int64_t(s.x.size()), [&](int64_t i) {
    const NodeId n(i);
    return s.m[n] > 0 ? 0.5 * s.m[n] * (dot(s.v[n], s.v[n]) - h * h / (s.m[n] * s.m[n]) * dot(s.f[n], s.f[n])) : 0.0;
  });
}

EnergyRow energy_row(const Physics& ph, const State& s) {
  const StoredEnergy stored = stored_energy(ph.elements, s);
  EnergyRow r;
  r.kinetic = kinetic_energy(s);
  r.elastic = stored.elastic, r.plastic = stored.plastic, r.collapse = stored.collapse;
  r.heat = stored.heat, r.eqps_max = stored.eqps_max, r.temperature_max = stored.temperature_max;
  r.filter = ph.filter ? ph.filter->energy(ph.elements, s) : 0;
  r.viscosity = ph.energy.viscosity, r.external = ph.energy.external, r.cracks = ph.energy.cracks;
  for (const auto& condition : ph.conditions)
    r.conditions += std::visit([](const auto& c) { return c.reaction.work; }, condition);
  r.residual = kinetic_product(s) + r.elastic + r.plastic + r.filter + r.collapse + r.viscosity + r.cracks -
               ph.energy.initial - r.external - r.conditions;
  return r;
}

}  // namespace bw::csd
