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
  parallel_for(int64_t(sum_.size()), [&](int64_t n) { sum_[NodeId(n)] = 0; });
  const auto for_corners = [&](int block, const auto& work) {
    const int32_t* nodes = el.blocks.nodes_of(block);
    for (int l = 0; l < lanes; ++l) {
      const SlotId slot(block * lanes + l);
      const double omega2 = s.omega2[slot] * distortion_[slot];
      for (int a = 0; a < 8; ++a)
        work(l, omega2 * mass_[size_t(block * 8 + a) * lanes + size_t(l)], NodeId(nodes[a * lanes + l]),
             mass_[size_t(block * 8 + a) * lanes + size_t(l)]);
    }
  };
  for_coloured_blocks(el.blocks, [&](int block, int) {
    for_corners(block, [&](int lane, double weight, NodeId n, double&) {
      if (lane < el.blocks.used[size_t(block)]) sum_[n] += weight;
    });
  });
  for_blocks(el.blocks, [&](int block, int) {
    for_corners(block, [&](int, double weight, NodeId n, double& mass) { mass = weight / sum_[n] * s.m[n]; });
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
          const size_t in_body = size_t(block - el.blocks.first_block[size_t(body)]);
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

}  // namespace

double TimeStep::stable(const Elements& el, const State& s) {
  const bool due = stale_ || s.step - refreshed_at_ >= refresh_steps;
  if (due) refresh(el, s, true);
  Worst w = worst_of(s, distortion_);
  if (w.collapsed && !due) {  // the centroid doesn't see a collapsing point: such elements are evaluated in every step
    refresh(el, s, false);
    w = worst_of(s, distortion_);
  }
  limiting_ = w.limiting;
  inverted_ = w.inverted.valid() ? std::optional(w.inverted) : std::nullopt;
  return 2 / std::sqrt(w.omega2);
}

}  // namespace bw::csd
