// SPDX-License-Identifier: Apache-2.0
#include "csd/energy_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/app/error.h"
#include "common/app/log.h"
#include "common/parallel/loop.h"
#include "csd/element/results.h"

namespace bw::csd {

EnergyAudit::EnergyAudit(const Model& m)
    : residual_(energy_row(m.physics, m.state).residual),
      f_(size_t(m.mesh.elem_count())),
      stored_(f_.size()),
      missing_(f_.size()) {
  look(m, true);
}

void EnergyAudit::add(const Model& m) {
  look(m, false);
  steps_ += 1;
}

void EnergyAudit::look(const Model& m, bool first) {
  const Elements& el = m.physics.elements;
  parallel_for(int64_t(f_.size()), [&](int64_t i) {
    const ElemId e(i);
    const SlotId slot = el.blocks.slot[e];
    if (!el.blocks.is_own(slot)) return;
    const ElementResult r = evaluate(el, m.state, slot);
    const double stored = r.elastic + r.plastic + r.collapse;
    const Corners<double> f = element_force(el, m.state, slot);
    if (!first) {
      double work = 0;  // of the element's forces on its nodes
      for (size_t a = 0; a < 8; ++a) {
        const NodeId n = m.mesh.hex[e][a];
        if (size_t(n) < x_.size()) work += 0.5 * dot(f.a[a] + f_[size_t(i)].a[a], m.state.x[n] - x_[n]);
      }
      missing_[size_t(i)] += stored - stored_[size_t(i)] + work;
    }
    f_[size_t(i)] = f, stored_[size_t(i)] = stored;
  });
  x_ = m.state.x;
}

std::string EnergyAudit::report(const Model& m) {
  if (m.physics.elements.ranks) m.physics.elements.ranks->complete(missing_);
  const double change = energy_row(m.physics, m.state).residual - residual_;
  std::vector<double> body(m.physics.elements.materials.size());
  double all = 0;
  size_t worst = 0;
  for (size_t e = 0; e < missing_.size(); ++e) {
    body[size_t(m.mesh.body[ElemId(int64_t(e))])] += missing_[e];
    all += missing_[e];
    if (std::fabs(missing_[e]) > std::fabs(missing_[worst])) worst = e;
  }
  const ElemId e{int64_t(worst)};
  Vec3 c;
  for (NodeId n : m.mesh.hex[e]) c += 0.125 * m.state.x[n];
  std::string bodies;
  for (size_t b = 0; b < body.size(); ++b) bodies += fmt::format("{}body {}: {:.3g} J", b ? ", " : "", b, body[b]);
  return fmt::format(
      "energy residual: over {} steps it changed by {:.3g} J; {:.3g} J arise in the elements ({}), most in element {} "
      "of "
      "body {} at ({:.6g}, {:.6g}, {:.6g}) m, {:.3g} J; the rest in filter, viscosity or cracks",
      steps_, change, all, bodies, m.mesh.elem_gid[e], m.mesh.body[e], c.x, c.y, c.z, missing_[worst]);
}

namespace {

/// J: what round-off of positions may do to the energy of the mesh.
double round_off(const Model& m) {
  constexpr double digits = 1e-14;  // of a volume; energies are differences of terms of its size
  const Elements& el = m.physics.elements;
  return digits * sum_elements(el, [&](SlotId slot) {
           const auto kappa = [](const auto& material) { return material.volumetric.kappa; };
           return m.state.V0[slot] * std::visit(kappa, el.materials[size_t(el.body_of(slot))]);
         });
}

}  // namespace

void EnergyWatch::check(const EnergyRow& row, Model& m) {
  scale_ =
      std::max({scale_, row.kinetic + row.elastic + row.plastic, std::fabs(row.external), std::fabs(row.conditions)});
  if (!round_off_) round_off_ = round_off(m);
  if (scale_ <= *round_off_) return;
  part_ = std::fabs(row.residual) / scale_;
  worst_ = std::max(worst_, part_);
  if (case_.stop > 0 && part_ > case_.stop)
    throw PhysicsError(
        fmt::format("energy residual {:.3g} J is {:.3g} % of the energy at hand, more than "
                    "solid.energy.stop, at step {}, t = {:.9g} s",
                    row.residual, 100 * part_, m.state.step, m.state.t));
  if (case_.warn > 0 && part_ > case_.warn && !warned_) {
    warned_ = true;
    warn("energy residual {:.3g} J is {:.3g} % of the energy at hand at step {}, t = {:.6g} s", row.residual,
         100 * part_, m.state.step, m.state.t);
    complete(m);
    audit_.emplace(m);
  }
}

void EnergyWatch::tick(const Model& m) {
  if (!audit_) return;
  audit_->add(m);
  if (audit_->steps() < audit_steps) return;
  warn("{}", audit_->report(m));
  audit_.reset();
}

}  // namespace bw::csd
