// SPDX-License-Identifier: Apache-2.0
#include "csd/element/time_step.h"

#include <cmath>

#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/stable_step.h"

namespace bw::csd {

void TimeStep::share_masses(const Elements& el, const State& s) {
  if (mass_.empty()) {
    mass_ = el.corner_mass;
    distortion_.resize(s.V0.size(), 1.0);
  }
  sum_.resize(s.m.size());
  s.for_nodes([&](NodeId n) { sum_[n] = 0; });
  const auto at = [&](int block, int a, int l) { return size_t(block * 8 + a) * lanes + size_t(l); };
  for_blocks(el.blocks, [&](int block, int) {
    for_corners(lanes, [&](int a, int l) {
      const SlotId slot(block * lanes + l);
      mass_[at(block, a, l)] *= s.omega2[slot] * distortion_[slot];
    });
  });
  for_coloured_blocks(el.blocks, [&](int block, int) {
    add_to_corners(
        el.blocks, block, [&](int a, int l) { return mass_[at(block, a, l)]; }, sum_);
  });
  el.finish_sum(sum_);
  for_blocks(el.blocks, [&](int block, int) {
    for_corners(lanes, [&](int a, int l) {
      const NodeId n(el.blocks.node[at(block, a, l)]);
      mass_[at(block, a, l)] = mass_[at(block, a, l)] / sum_[n] * s.m[n];
    });
  });
}

namespace {

/// Bound over centroid part, for the elements of a block.
template <class M>
[[gnu::flatten]] void block_distortion(const Elements& el, const M& material, const double* history, int block,
                                       const Aligned<double>& masses, const State& s,
                                       Field<double, SlotId>& distortion) {
  for (int l = 0; l < lanes; l += Pack::size) {
    const SlotId slot(block * lanes + l);
    Pack mass[8];
    for (int a = 0; a < 8; ++a) mass[a] = Pack::load(&masses[size_t(block * 8 + a) * lanes + size_t(l)]);
    const Pack V0 = Pack::load(&s.V0[slot]), volume = Pack::load(&s.volume[slot]);
    const Pack sigma = material.volumetric.mean_stress(volume / V0);
    const Corners<Pack> x = gather(s.x.data(), el.blocks.nodes_of(block) + l);
    const Pack bound = omega2_bound<Pack>(material, x, V0, mass, sigma, history + l);
    (bound / Pack::load(&s.omega2[slot])).store(&distortion[slot]);
  }
}

bool has_collapsed(const State& s, int block) {
  for (int l = 0; l < lanes; ++l)
    if (s.collapsed[SlotId(block * lanes + l)] > 0) return true;
  return false;
}

}  // namespace

void TimeStep::refresh(const Elements& el, const State& s, bool whole) {
  if (whole) share_masses(el, s);
  for_blocks(el.blocks, [&](int block, int body) {
    if (!whole && !has_collapsed(s, block)) return;
    std::visit(
        [&]<class M>(const M& material) {
          const size_t in_body = size_t(el.blocks.row_of(body, block));
          const double* history = s.history[size_t(body)].data() + in_body * 8 * M::components * lanes;
          block_distortion(el, material, history, block, mass_, s, distortion_);
        },
        el.materials[size_t(body)]);
  });
  if (!whole) return;
  refreshed_at_ = s.step;
  stale_ = false;
}

namespace {

struct Worst {
  double omega2 = 0;
  SlotId limiting, inverted;
  bool collapsed = false;
};
Worst worse(const Worst& a, const Worst& b) {  // a comes first: it wins ties
  return {std::fmax(a.omega2, b.omega2), b.omega2 > a.omega2 ? b.limiting : a.limiting,
          a.inverted.valid() ? a.inverted : b.inverted, a.collapsed || b.collapsed};
}
Worst worst_of(const State& s, const Field<double, SlotId>& distortion) {
  return parallel_reduce(
      int64_t(distortion.size()), Worst{},
      [&](int64_t i) {
        const SlotId slot(i);
        return Worst{s.omega2[slot] * distortion[slot], slot, s.volume[slot] > 0 ? SlotId() : slot,
                     s.collapsed[slot] > 0};
      },
      worse);
}

/// Exact; ties: lowest slot, whichever rank has it.
Worst worst_of_all(const Comm& comm, Worst w) {
  for (const Worst& b : comm.gather_one(w)) {
    if (b.omega2 > w.omega2 || (b.omega2 == w.omega2 && b.limiting < w.limiting)) w.limiting = b.limiting;
    w.omega2 = std::fmax(w.omega2, b.omega2);
    if (b.inverted.valid() && !(w.inverted.valid() && w.inverted < b.inverted)) w.inverted = b.inverted;
  }
  return w;
}

}  // namespace

double TimeStep::stable(const Elements& el, const State& s) {
  const bool due = stale_ || s.step - refreshed_at_ >= refresh_steps;
  if (due) refresh(el, s, true);
  Worst w = worst_of(s, distortion_);
  if (w.collapsed && !due) {  // the centroid doesn't see a collapsing point: such elements are evaluated in every step
    refresh(el, s, false);
    w = worst_of(s, distortion_);
  }
  if (el.ranks) w = worst_of_all(el.ranks->comm(), w);
  limiting_ = w.limiting;
  inverted_ = w.inverted.valid() ? std::optional(w.inverted) : std::nullopt;
  return 2 / std::sqrt(w.omega2);
}

}  // namespace bw::csd
