// SPDX-License-Identifier: Apache-2.0
#include "csd/load/mass_scaling.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/error.h"

namespace bw::csd {

MassScaling::MassScaling(const MassScalingCase& cs, const State& s) : case_(cs) {
  for (size_t n = 0; n < s.m.size(); ++n) whole_ += s.m[NodeId(int64_t(n))];
}

void MassScaling::add(const Mesh& mesh, Elements& el, TimeStep& time_step, ElemId e, double part, State& s) {
  heavier_ += 1;
  std::array<double, 8> more = corner_masses(mesh, el, e);
  for (size_t a = 0; a < 8; ++a) {
    const NodeId n = mesh.hex[e][a];
    more[a] *= part;
    s.m[n] += more[a], added_ += more[a];
    energy_ += 0.5 * more[a] * dot(s.v[n], s.v[n]);
  }
  if (el.blocks.is_own(el.blocks.slot[e])) time_step.make_heavier(el, e, more);
  el.mass_factor.resize(size_t(mesh.elem_count()), 1.0);
  el.mass_factor[size_t(e)] *= 1 + part;
}

namespace {

/// The stable step once neighbours have lent each other what they can: each look at the masses goes a part of the way.
double settled_step(const Elements& el, TimeStep& time_step, const State& s, double stable) {
  for (double before = 0; stable > 1.001 * before;) {
    before = stable;
    time_step.renew();
    stable = time_step.stable(el, s);
  }
  return stable;
}

}  // namespace

double MassScaling::enforce(const Mesh& mesh, Elements& el, TimeStep& time_step, double safety, double stable,
                            State& s) {
  const double wanted = case_.minimum_step / safety;
  for (int pass = 0; pass < 50 && stable < wanted; ++pass) {
    stable = settled_step(el, time_step, s, stable);
    if (stable >= wanted) break;
    std::vector<double> part(el.blocks.slot.size());  // to be added, of an element's own mass
    for (size_t i = 0; i < part.size(); ++i) {
      const ElemId e{int64_t(i)};
      const SlotId slot = el.blocks.slot[e];
      if (!el.blocks.is_own(slot)) continue;
      const double factor = 0.25 * wanted * wanted * time_step.omega2(s, slot);
      if (!(factor > 1)) continue;
      if (const double borrowed = time_step.borrowed(el, e, corner_masses(mesh, el, e)); factor * borrowed > 1)
        part[i] = (1.01 * factor - 1) * borrowed;
    }
    if (el.ranks) el.ranks->complete(part), el.ranks->complete(s);  // velocities, for the energy that comes along
    if (std::all_of(part.begin(), part.end(), [](double p) { return p == 0; })) {
      time_step.lend_nothing(mesh, el, s);
      continue;
    }
    for (size_t i = 0; i < part.size(); ++i)
      if (part[i] > 0) add(mesh, el, time_step, ElemId(int64_t(i)), part[i], s);
    if (added_ > case_.limit * whole_)
      throw PhysicsError(
          fmt::format("mass scaling for a step of {:.3g} s would add more than {:.3g} % of the mass ({:.3g} of {:.3g} "
                      "kg) at step {}: a shorter minimum_step, or a higher limit",
                      case_.minimum_step, 100 * case_.limit, added_, whole_, s.step));
  }
  return stable;
}

}  // namespace bw::csd
