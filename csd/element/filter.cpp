// SPDX-License-Identifier: Apache-2.0
#include "csd/element/filter.h"

#include <cmath>
#include <map>

#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/results.h"

namespace bw::csd {
namespace {

/// Elements of rigid bodies keep what they had: they share no node with others. Blocks of them alone are passed over.
bool is_rigid(const State& s, SlotId slot) { return s.rigid.size() > 0 && s.rigid[slot] > 0; }
bool is_rigid(const State& s, int block) {
  if (s.rigid.size() == 0) return false;
  for (int l = 0; l < lanes; ++l)
    if (s.rigid[SlotId(block * lanes + l)] == 0) return false;
  return true;
}

/// v_e / V_e at s.x; `skips`: but of rigid bodies.
void volume_ratios(const Elements& el, const State& s, Field<double, SlotId>& J, bool skips) {
  for_blocks(el.blocks, [&](int block, int) {
    if (skips && is_rigid(s, block)) return;
    for (int l = 0; l < lanes; l += Pack::size) {
      const SlotId slot(block * lanes + l);
      const Pack v = volume_of(modes_of(gather(s.x.data(), el.blocks.nodes_of(block) + l)));
      (v / Pack::load(&s.V0[slot])).store(&J[slot]);
    }
  });
}

/// U'(J) of each element's material [Pa].
void mean_stresses(const Elements& el, const Field<double, SlotId>& J, Field<double, SlotId>& sigma) {
  for_blocks(el.blocks, [&](int block, int body) {
    const Volumetric& U =
        std::visit([](const auto& m) -> const Volumetric& { return m.volumetric; }, el.materials[size_t(body)]);
    for (int l = 0; l < lanes; l += Pack::size) {
      const SlotId slot(block * lanes + l);
      U.mean_stress(Pack::load(&J[slot])).store(&sigma[slot]);
    }
  });
}

/// Nodal sums of what elements have; `skips`: but of rigid bodies.
void nodal_sums(const Elements& el, const State& s, const Field<double, SlotId>& a, Field<double, NodeId>& sum,
                bool skips) {
  s.for_nodes([&](NodeId n) { sum[n] = 0; });
  for_coloured_blocks(el.blocks, [&](int block, int) {
    if (skips && is_rigid(s, block)) return;
    add_to_corners(
        el.blocks, block, [&](int, int l) { return a[SlotId(block * lanes + l)]; }, sum);
  });
  el.finish_sum(sum);
}

/// work(slot) for all slots of this rank's blocks.
template <class Work>
void for_slots(const Elements& el, const Work& work) {
  for_blocks(el.blocks, [&](int block, int) {
    for (int l = 0; l < lanes; ++l) work(SlotId(block * lanes + l));
  });
}
const Volumetric& volumetric_of(const Elements& el, SlotId slot) {
  return std::visit([](const auto& m) -> const Volumetric& { return m.volumetric; },
                    el.materials[size_t(el.body_of(slot))]);
}

}  // namespace

PressureFilter::PressureFilter(const FilterCase& cs, const Elements& el, const State& s)
    : case_(cs), self_adjoint_(cs.kind == "self_adjoint"), strength_(cs.strength) {
  const size_t slots = size_t(el.blocks.slot_count());
  J_.resize(slots), theta_.resize(slots), stress_.resize(slots);
  renew(el, s);
}

void PressureFilter::renew(const Elements& el, const State& s) {
  share_.resize(s.x.size());
  sum_.resize(s.x.size());
  nodal_sums(el, s, s.V0, sum_, false);
  parallel_for(int64_t(sum_.size()), [&](int64_t n) { share_[NodeId(n)] = 0.125 / sum_[NodeId(n)]; });
}

double PressureFilter::open(const Mesh& mesh, const Topology& topology, const Elements& el, const State& s,
                            std::span<const NodeId> touched) {
  if (self_adjoint_ && case_.gate == "none" && sigma_.size() > 0) return open_locally(mesh, topology, el, s, touched);
  const double before = energy(el, s);
  renew(el, s);
  smooth(el, s);
  return before - energy(el, s);
}

/// Nodal means change at the touched nodes alone, A_b J in the elements around them.
double PressureFilter::open_locally(const Mesh& mesh, const Topology& topology, const Elements& el, const State& s,
                                    std::span<const NodeId> touched) {
  const size_t nodes_before = share_.size();
  std::vector<char> is_near(size_t(mesh.elem_count()), 0);
  for (const NodeId n : touched)
    for (const ElemId e : topology.elements(n)) is_near[size_t(e)] = 1;
  struct Known {  // of an element, from its owner
    double V, J, theta;
  };
  const auto own = [&](ElemId e) {
    const SlotId slot = el.blocks.slot[e];
    return Known{s.V0[slot], J_[slot], theta_[slot]};
  };
  std::vector<Known> all;
  if (el.ranks) all = el.ranks->complete_some<Known>(is_near, own);
  const auto known = [&](ElemId e) { return el.ranks ? all[size_t(e)] : own(e); };
  struct Sums {
    double V = 0, VJ = 0;
  };
  std::map<int32_t, Sums> old_sums;  // of the node that each was split from
  std::vector<Sums> sums(touched.size());
  const auto root = [&](NodeId n) {
    while (size_t(n) >= nodes_before) n = mesh.parent[n];
    return n;
  };
  for (size_t i = 0; i < touched.size(); ++i) {
    for (const ElemId e : topology.elements(touched[i])) {
      const Known k = known(e);
      sums[i].V += k.V, sums[i].VJ += k.V * k.J;
    }
    Sums& old = old_sums[root(touched[i])];
    old.V += sums[i].V, old.VJ += sums[i].VJ;
  }
  share_.resize(s.x.size()), sum_.resize(s.x.size());
  std::map<int32_t, double> change;  // of A_b J, by element
  for (size_t i = 0; i < touched.size(); ++i) {
    share_[touched[i]] = 0.125 / sums[i].V;
    const Sums& old = old_sums[root(touched[i])];
    const double jump = sums[i].VJ / sums[i].V - old.VJ / old.V;
    for (const ElemId e : topology.elements(touched[i])) change[e] += 0.125 * strength_ * jump;
  }
  double released = 0;
  for (const auto& [e, jump] : change) {
    const SlotId slot = el.blocks.slot[ElemId(e)];
    const Volumetric& U = volumetric_of(el, slot);
    const Known k = known(ElemId(e));
    released += k.V * (U.energy(k.theta) - U.energy(k.theta + jump));
    if (el.blocks.is_own(slot)) theta_[slot] += jump;
  }
  return released;
}

void PressureFilter::mean(const Elements& el, const State& s, const Field<double, SlotId>& a,
                          Field<double, SlotId>& out) {
  average(el, s, a, 1, out);
}

void PressureFilter::average(const Elements& el, const State& s, const Field<double, SlotId>& a, double strength,
                             Field<double, SlotId>& out) {
  for_blocks(el.blocks, [&](int block, int) {
    if (skips_rigid_ && is_rigid(s, block)) return;
    for (SlotId slot(block * lanes); slot < (block + 1) * lanes; slot = SlotId(slot + 1))
      if (!skips_rigid_ || !is_rigid(s, slot)) out[slot] = s.V0[slot] * a[slot];
  });
  nodal_sums(el, s, out, sum_, skips_rigid_);
  s.for_nodes([&](NodeId n) { sum_[n] *= share_[n]; });
  for_blocks(el.blocks, [&](int block, int) {
    if (skips_rigid_ && is_rigid(s, block)) return;
    const int32_t* nodes = el.blocks.nodes_of(block);
    for (int l = 0; l < lanes; ++l) {
      if (skips_rigid_ && is_rigid(s, SlotId(block * lanes + l))) continue;
      const auto at = [&](int c) { return sum_[NodeId(nodes[c * lanes + l])]; };
      const double mean = ((at(0) + at(1)) + (at(2) + at(3))) + ((at(4) + at(5)) + (at(6) + at(7)));
      const SlotId slot(block * lanes + l);
      out[slot] = (1 - strength) * a[slot] + strength * mean;
    }
  });
}

const Field<double, SlotId>& PressureFilter::smooth(const Elements& el, const State& s) {
  sigma_.resize(J_.size());
  volume_ratios(el, s, J_, skips_rigid_);
  if (case_.gate != "none") {
    smooth_gated(el, s);
  } else if (self_adjoint_) {
    average(el, s, J_, strength_, theta_);
    mean_stresses(el, theta_, stress_);
    average(el, s, stress_, strength_, sigma_);
  } else {
    mean_stresses(el, J_, stress_);
    average(el, s, stress_, strength_, sigma_);
    book_work(el, s);
  }
  return sigma_;
}

void PressureFilter::renew_gate(const Elements& el, const State& s) {
  const size_t slots = J_.size();
  const bool first = gate_.size() == 0;
  gate_.resize(slots), mean_.resize(slots), rough_.resize(slots), eqps_.resize(slots);
  if (case_.gate != "plastic") {
    mean_stresses(el, J_, stress_);
    mean(el, s, stress_, mean_);
    for_slots(el, [&](SlotId i) { rough_[i] = stress_[i] - mean_[i]; });
    mean(el, s, rough_, theta_);
  }
  for_slots(el, [&](SlotId slot) {
    bool acts = !first;
    if (case_.gate != "plastic") {
      const double size = std::abs(rough_[slot]), floor = 1e-4 * volumetric_of(el, slot).kappa;
      acts = acts && size > case_.threshold * (std::abs(mean_[slot]) + floor) && std::abs(theta_[slot]) < 0.5 * size;
    }
    if (case_.gate != "checkerboard") {
      const double eqps = mean_eqps(el, s, slot);
      acts = acts && eqps > eqps_[slot];
      eqps_[slot] = eqps;
    }
    gate_[slot] = acts || gate_[slot] != 0;
  });
}

void PressureFilter::smooth_gated(const Elements& el, const State& s) {
  renew_gate(el, s);
  if (!self_adjoint_) {
    mean_stresses(el, J_, stress_);
    mean(el, s, stress_, mean_);
    for_slots(el, [&](SlotId i) { sigma_[i] = stress_[i] + strength_ * gate_[i] * (mean_[i] - stress_[i]); });
    return book_work(el, s);
  }
  mean(el, s, J_, mean_);
  for_slots(el, [&](SlotId i) { theta_[i] = J_[i] + strength_ * gate_[i] * (mean_[i] - J_[i]); });
  mean_stresses(el, theta_, stress_);
  for_slots(el, [&](SlotId i) { rough_[i] = gate_[i] * stress_[i]; });
  mean(el, s, rough_, mean_);
  for_slots(el, [&](SlotId i) { sigma_[i] = stress_[i] + strength_ * (mean_[i] - rough_[i]); });
  mean_stresses(el, J_, stress_);
  book_work(el, s);
}

void PressureFilter::book_work(const Elements& el, const State& s) {
  const bool first = change_.size() == 0;
  change_.resize(J_.size()), volume_.resize(J_.size());
  work_ += sum_elements(el, [&](SlotId slot) {
    const double change = sigma_[slot] - stress_[slot], volume = J_[slot] * s.V0[slot];
    const double work = first ? 0 : 0.5 * (change + change_[slot]) * (volume - volume_[slot]);
    change_[slot] = change, volume_[slot] = volume;
    return work;
  });
}

double PressureFilter::energy(const Elements& el, const State& s) const {
  if (!self_adjoint_ || case_.gate != "none" || !sigma_.size()) return work_;
  return sum_elements(el, [&](SlotId slot) {
    const Volumetric& U = volumetric_of(el, slot);
    return s.V0[slot] * (U.energy(theta_[slot]) - U.energy(J_[slot]));
  });
}

double checkerboard(const Elements& el, const State& s) {
  PressureFilter whole(FilterCase{.kind = "plain", .strength = 1.0}, el, s);
  whole.skips_rigid_ = false;
  volume_ratios(el, s, whole.J_, false);
  mean_stresses(el, whole.J_, whole.stress_);
  whole.average(el, s, whole.stress_, 1.0, whole.theta_);
  const double rough =
      sum_elements(el, [&](SlotId i) { return s.V0[i] * std::abs(whole.stress_[i] - whole.theta_[i]); });
  const double all = sum_elements(el, [&](SlotId i) { return s.V0[i] * std::abs(whole.stress_[i]); });
  const double noise = sum_elements(el, [&](SlotId i) { return s.V0[i] * volumetric_of(el, i).kappa; });
  return all > 1e-12 * noise ? rough / all : 0;
}

}  // namespace bw::csd
