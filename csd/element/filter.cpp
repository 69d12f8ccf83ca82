// SPDX-License-Identifier: Apache-2.0
#include "csd/element/filter.h"

#include <cmath>
#include <map>

#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/results.h"
#include "csd/rigid_blocks.h"

namespace bw::csd {
namespace {

/// v_e / V_e at s.x of Pack::size elements.
Pack volume_ratio(const Elements& el, const State& s, int block, int first) {
  return volume_of(modes_of(gather(s.x.data(), el.blocks.nodes_of(block) + first))) /
         Pack::load(&s.V0[SlotId(block * lanes + first)]);
}
const Volumetric& volumetric_of_body(const Elements& el, int body) {
  return std::visit([](const auto& m) -> const Volumetric& { return m.volumetric; }, el.materials[size_t(body)]);
}
const Volumetric& volumetric_of(const Elements& el, SlotId slot) { return volumetric_of_body(el, el.body_of(slot)); }

/// v_e / V_e at s.x; `skips`: but of blocks of rigid bodies.
void volume_ratios(const Elements& el, const State& s, bool skips, Field<double, SlotId>& J) {
  for_blocks(el.blocks, [&](int block, int) {
    if (skips && is_rigid_block(s, block)) return;
    for (int l = 0; l < lanes; l += Pack::size) volume_ratio(el, s, block, l).store(&J[SlotId(block * lanes + l)]);
  });
}

/// U'(J) of each element's material [Pa].
void mean_stresses(const Elements& el, const Field<double, SlotId>& J, Field<double, SlotId>& sigma) {
  for_blocks(el.blocks, [&](int block, int body) {
    const Volumetric& U = volumetric_of_body(el, body);
    for (int l = 0; l < lanes; l += Pack::size) {
      const SlotId slot(block * lanes + l);
      U.mean_stress(Pack::load(&J[slot])).store(&sigma[slot]);
    }
  });
}

/// Nodal sums of what fill(block, body, first) leaves in `addends`, Pack::size elements from `first` on; `skips`: but
/// of rigid bodies. sum: zero before.
template <class Fill>
void add_to_nodes(const Elements& el, const State& s, bool skips, const Field<double, SlotId>& addends,
                  Field<double, NodeId>& sum, const Fill& fill) {
  for_coloured_blocks(el.blocks, [&](int block, int body) {
    if (skips && is_rigid_block(s, block)) return;
    for (int l = 0; l < lanes; l += Pack::size) fill(block, body, l);
    add_to_corners(
        el.blocks, block, [&](int, int l) { return addends[SlotId(block * lanes + l)]; }, sum);
  });
  el.finish_sum(sum);
}

/// Sum over an element's nodes, of Pack::size elements.
Pack sum_over_corners(const Field<double, NodeId>& a, const int32_t* nodes) {
  const auto at = [&](int c) {
    Pack r;
    for (int l = 0; l < Pack::size; ++l) r.set(l, a[NodeId(nodes[c * lanes + l])]);
    return r;
  };
  return ((at(0) + at(1)) + (at(2) + at(3))) + ((at(4) + at(5)) + (at(6) + at(7)));
}

/// Stores `now`, but elements of rigid bodies keep what they have.
void store_deformable(const State& s, bool skips, SlotId slot, Pack now, Field<double, SlotId>& out) {
  if (skips && s.rigid.size() > 0) now = select(Pack::load(&s.rigid[slot]) > Pack(0), Pack::load(&out[slot]), now);
  now.store(&out[slot]);
}

/// work(slot) for all slots of this rank's blocks.
template <class Work>
void for_slots(const Elements& el, const Work& work) {
  for_blocks(el.blocks, [&](int block, int) {
    for (int l = 0; l < lanes; ++l) work(SlotId(block * lanes + l));
  });
}
}  // namespace

PressureFilter::PressureFilter(const FilterCase& cs, const Elements& el, const State& s)
    : case_(cs), self_adjoint_(cs.kind == "self_adjoint"), strength_(cs.strength) {
  const size_t slots = size_t(el.blocks.slot_count());
  for (auto* field : {&J_, &theta_, &stress_, &addends_}) field->resize(slots);
  renew(el, s);
}

void PressureFilter::renew(const Elements& el, const State& s) {
  share_.resize(s.x.size());
  sum_.resize(s.x.size());
  parallel_for(int64_t(sum_.size()), [&](int64_t n) { sum_[NodeId(n)] = 0; });
  add_to_nodes(el, s, false, s.V0, sum_, [](int, int, int) {});
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
  const auto for_nodes = [&](const auto& work) {
    if (skips_rigid_)
      s.for_nodes(work);
    else
      parallel_for(int64_t(sum_.size()), [&](int64_t n) { work(NodeId(n)); });
  };
  for_nodes([&](NodeId n) { sum_[n] = 0; });
  add_to_nodes(el, s, skips_rigid_, addends_, sum_, [&](int block, int, int l) {
    const SlotId slot(block * lanes + l);
    (Pack::load(&s.V0[slot]) * Pack::load(&a[slot])).store(&addends_[slot]);
  });
  for_nodes([&](NodeId n) { sum_[n] *= share_[n]; });
  for_blocks(el.blocks, [&](int block, int) {
    if (skips_rigid_ && is_rigid_block(s, block)) return;
    for (int l = 0; l < lanes; l += Pack::size) blend(el, s, block, l, a, strength, sum_, out);
  });
}

/// out = (1 - strength) a + strength times the sum of `means` over the nodes, of Pack::size elements.
void PressureFilter::blend(const Elements& el, const State& s, int block, int first, const Field<double, SlotId>& a,
                           double strength, const Field<double, NodeId>& means, Field<double, SlotId>& out) const {
  const SlotId slot(block * lanes + first);
  const Pack mean = sum_over_corners(means, el.blocks.nodes_of(block) + first);
  store_deformable(s, skips_rigid_, slot, Pack(1 - strength) * Pack::load(&a[slot]) + Pack(strength) * mean, out);
}

const Field<double, SlotId>& PressureFilter::smooth(const Elements& el, const State& s) {
  sigma_.resize(J_.size());
  if (case_.gate == "none" && self_adjoint_) {
    smooth_self_adjoint(el, s);
    return sigma_;
  }
  volume_ratios(el, s, skips_rigid_, J_);
  if (case_.gate != "none") {
    smooth_gated(el, s);
  } else {
    mean_stresses(el, J_, stress_);
    average(el, s, stress_, strength_, sigma_);
    book_work(el, s);
  }
  return sigma_;
}

/// theta = A_b J and sigma = A_b U'(theta) in three passes over the elements.
void PressureFilter::smooth_self_adjoint(const Elements& el, const State& s) {
  next_sum_.resize(sum_.size());
  s.for_nodes([&](NodeId n) { sum_[n] = 0; });
  add_to_nodes(el, s, skips_rigid_, addends_, sum_, [&](int block, int, int l) {
    const SlotId slot(block * lanes + l);
    const Pack J = volume_ratio(el, s, block, l);
    J.store(&J_[slot]);
    (Pack::load(&s.V0[slot]) * J).store(&addends_[slot]);
  });
  s.for_nodes([&](NodeId n) { sum_[n] *= share_[n], next_sum_[n] = 0; });
  add_to_nodes(el, s, skips_rigid_, addends_, next_sum_, [&](int block, int body, int l) {
    const SlotId slot(block * lanes + l);
    blend(el, s, block, l, J_, strength_, sum_, theta_);
    const Pack stress = volumetric_of_body(el, body).mean_stress(Pack::load(&theta_[slot]));
    stress.store(&stress_[slot]);
    (Pack::load(&s.V0[slot]) * stress).store(&addends_[slot]);
  });
  s.for_nodes([&](NodeId n) { next_sum_[n] *= share_[n]; });
  for_blocks(el.blocks, [&](int block, int) {
    if (skips_rigid_ && is_rigid_block(s, block)) return;
    for (int l = 0; l < lanes; l += Pack::size) blend(el, s, block, l, stress_, strength_, next_sum_, sigma_);
  });
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

double Checkerboard::of(const Elements& el, const State& s) {
  if (!whole_) {
    whole_.emplace(FilterCase{.kind = "plain", .strength = 1.0}, el, s);
    whole_->skips_rigid_ = false;
  }
  PressureFilter& whole = *whole_;
  if (whole.share_.size() != s.x.size()) whole.renew(el, s);
  for_slots(el, [&](SlotId i) { whole.J_[i] = s.volume[i] / s.V0[i]; });
  mean_stresses(el, whole.J_, whole.stress_);
  whole.average(el, s, whole.stress_, 1.0, whole.theta_);
  const double rough =
      sum_elements(el, [&](SlotId i) { return s.V0[i] * std::abs(whole.stress_[i] - whole.theta_[i]); });
  const double all = sum_elements(el, [&](SlotId i) { return s.V0[i] * std::abs(whole.stress_[i]); });
  const double noise = sum_elements(el, [&](SlotId i) { return s.V0[i] * volumetric_of(el, i).kappa; });
  return all > 1e-12 * noise ? rough / all : 0;
}

}  // namespace bw::csd
