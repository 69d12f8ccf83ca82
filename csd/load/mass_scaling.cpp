// SPDX-License-Identifier: Apache-2.0
#include "csd/load/mass_scaling.h"

#include <fmt/format.h>

#include "common/app/error.h"

namespace bw::csd {

MassScaling::MassScaling(const MassScalingCase& cs, const State& s) : case_(cs) {
  for (size_t n = 0; n < s.m.size(); ++n) whole_ += s.m[NodeId(int64_t(n))];
}

void MassScaling::add(const Mesh& mesh, Elements& el, ElemId e, double part, State& s) {
  heavier_ += 1;
  for (int a = 0; const double mass : corner_masses(mesh, el, e)) {
    const NodeId n = mesh.hex[e][size_t(a++)];
    const double more = part * mass;
    s.m[n] += more, added_ += more;
    energy_ += 0.5 * more * dot(s.v[n], s.v[n]);
  }
  el.mass_factor.resize(size_t(mesh.elem_count()), 1.0);
  el.mass_factor[size_t(e)] *= 1 + part;
}

double MassScaling::enforce(const Mesh& mesh, Elements& el, TimeStep& time_step, double safety, double stable,
                            State& s) {
  const double wanted = case_.minimum_step / safety;
  for (int pass = 0; pass < 50 && stable < wanted; ++pass) {
    std::vector<double> omega2(el.blocks.slot.size());
    for (size_t e = 0; e < omega2.size(); ++e)
      if (const SlotId slot = el.blocks.slot[ElemId(int64_t(e))]; el.blocks.is_own(slot))
        omega2[e] = time_step.omega2(s, slot);
    if (el.ranks) el.ranks->complete(omega2), el.ranks->complete(s);  // velocities, for the energy that comes along
    for (size_t e = 0; e < omega2.size(); ++e)
      if (const double factor = 0.25 * wanted * wanted * omega2[e]; factor > 1)
        add(mesh, el, ElemId(int64_t(e)), 1.01 * factor - 1, s);
    if (added_ > case_.limit * whole_)
      throw PhysicsError(
          fmt::format("mass scaling for a step of {:.3g} s would add more than {:.3g} % of the mass ({:.3g} of {:.3g} "
                      "kg) at step {}: a shorter minimum_step, or a higher limit",
                      case_.minimum_step, 100 * case_.limit, added_, whole_, s.step));
    time_step.renew();
    stable = time_step.stable(el, s);
  }
  return stable;
}

}  // namespace bw::csd
