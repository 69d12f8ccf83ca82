// SPDX-License-Identifier: Apache-2.0
#include "csd/element/time_step.h"

#include <cmath>

#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/stable_step.h"

namespace bw::csd {

TimeStep::TimeStep(const Mesh& mesh, const Elements& el)
    : mass_(size_t(el.blocks.slot_count()) * 8), distortion_(size_t(el.blocks.slot_count()), 1.0) {
  for (int s = 0; s < el.blocks.slot_count(); ++s) {
    const ElemId e = el.blocks.elem[SlotId(s)];
    const double density = std::visit([](const auto& m) { return m.density; }, el.materials[size_t(mesh.body[e])]);
    const auto share = row_sums(corners(mesh, e));
    for (int a = 0; a < 8; ++a) mass_[size_t((s / lanes * 8 + a) * lanes + s % lanes)] = density * share[size_t(a)];
  }
}

void TimeStep::refresh(const Elements& el, const State& s) {
  for_blocks(el.blocks, [&](int block, int body) {
    const int32_t* nodes = el.blocks.nodes_of(block);
    std::visit(
        [&]<class M>(const M& material) {
          const double* history = s.history[size_t(body)].data() +
                                  size_t(block - el.blocks.first_block[size_t(body)]) * 8 * M::components * lanes;
          for (int l = 0; l < lanes; l += Pack::size) {
            const SlotId slot(block * lanes + l);
            Pack mass[8];
            for (int a = 0; a < 8; ++a) mass[a] = Pack::load(&mass_[size_t(block * 8 + a) * lanes + size_t(l)]);
            const Pack V0 = Pack::load(&s.V0[slot]), volume = Pack::load(&s.volume[slot]);
            const Pack sigma = material.volumetric.mean_stress(volume / V0);
            const Pack bound = omega2_bound<Pack>(material, gather(s.x.data(), nodes + l), V0, mass, sigma, history + l);
            (bound / Pack::load(&s.omega2[slot])).store(&distortion_[slot]);
          }
        },
        el.materials[size_t(body)]);
  });
  refreshed_at_ = s.step;
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
  if (s.step - refreshed_at_ >= refresh_steps || s.step < refreshed_at_) refresh(el, s);
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
