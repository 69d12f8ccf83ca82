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

}  // namespace

void TimeStep::refresh(const Elements& el, const State& s) {
  share_masses(el, s);
  for_blocks(el.blocks, [&](int block, int body) {
    std::visit(
        [&]<class M>(const M& material) {
          const size_t in_body = size_t(block - el.blocks.first_block[size_t(body)]);
          const double* history = s.history[size_t(body)].data() + in_body * 8 * M::components * lanes;
          block_distortion(el, material, history, block, mass_, s, distortion_);
        },
        el.materials[size_t(body)]);
  });
  refreshed_at_ = s.step;
  stale_ = false;
}

double TimeStep::stable(const Elements& el, const State& s) {
  struct Worst {
    double omega2 = 0;
    SlotId limiting, inverted;
  };
  const auto worse = [](const Worst& a, const Worst& b) {  // a comes first: it wins ties
    return Worst{std::fmax(a.omega2, b.omega2), b.omega2 > a.omega2 ? b.limiting : a.limiting,
                 a.inverted.valid() ? a.inverted : b.inverted};
  };
  if (stale_ || s.step - refreshed_at_ >= refresh_steps) refresh(el, s);
  const Worst w = parallel_reduce(
      el.blocks.slot_count(), Worst{},
      [&](int64_t i) {
        const SlotId slot(i);
        return Worst{s.omega2[slot] * distortion_[slot], slot, s.volume[slot] > 0 ? SlotId() : slot};
      },
      worse);
  limiting_ = w.limiting;
  inverted_ = w.inverted.valid() ? std::optional(w.inverted) : std::nullopt;
  return 2 / std::sqrt(w.omega2);
}

}  // namespace bw::csd
