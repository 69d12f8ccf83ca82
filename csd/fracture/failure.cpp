// SPDX-License-Identifier: Apache-2.0
#include "csd/fracture/failure.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "csd/element/results.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

Failure::Failure(const FractureInput& input, const Mesh& mesh, const std::vector<FailureData>& materials)
    : skip_safe_(input.skip_safe), values_(size_t(mesh.elem_count())) {
  const int bodies = mesh.elem_count() > 0 ? 1 + *std::max_element(mesh.body.begin(), mesh.body.end()) : 0;
  criteria_.assign(size_t(bodies), input.criterion.model);
  for (size_t body = 0; body < std::min(criteria_.size(), materials.size()); ++body)
    std::visit(
        [&](auto& criterion) {
          if constexpr (requires { criterion.take(materials[body]); }) criterion.take(materials[body]);
        },
        criteria_[body]);
  const int width = std::visit([]<class C>(const C&) { return C::memory; }, input.criterion.model);
  memory_.resize(values_.size() * size_t(width));
  if (!input.scatter) return;
  for (int32_t i = 0; i < mesh.elem_count(); ++i)
    strength_.push_back(
        input.scatter->strength(mesh.elem_gid[ElemId(i)], hex_volume(corners(mesh.hex[ElemId(i)], mesh.X)).volume));
}

namespace {

template <Criterion C>
Sample sample_of(const C& criterion, const Elements& el, const State& s, SlotId slot, double eqps, bool skip_safe,
                 const Field<double, SlotId>* sigma_m, const double* memory) {
  Sample sample{.eqps = eqps, .mises_most = std::numeric_limits<double>::infinity(), .dt = s.dt};
  if constexpr (C::reads_pressure) {
    sample.sigma_m = sigma_m ? (*sigma_m)[slot] : mean_stress(el, s, slot);
    if (skip_safe) sample.mises_most = mises_most(el, s, slot);
  }
  if (!criterion.wants_stress(sample, memory)) return sample;
  const ElementResult r = evaluate(el, s, slot, sigma_m);
  sample.has_stress = true, sample.sigma = r.sigma, sample.temperature = r.temperature;
  return sample;
}

}  // namespace

void Failure::update(const Elements& el, const State& s, const Resting& resting, const Field<double, SlotId>* sigma_m) {
  looked_at_.assign(size_t(el.blocks.block_count()), 0);
  const auto is_resting = [&](int block) {
    return skip_safe_ && resting.any() && resting.state[size_t(block)] == Resting::skipped;
  };
  for_blocks(el.blocks, [&](int block, int body) {
    if (is_resting(block)) return;
    if (resting.any() && resting.state[size_t(block)] == Resting::rigid) {  // rigid bodies don't break
      for (int l = 0; l < el.blocks.used[size_t(block)]; ++l)
        values_[size_t(el.blocks.elem[SlotId(block * lanes + l)])] = 0;
      return;
    }
    double eqps[lanes];
    mean_eqps(el, s, block, body, eqps);
    std::visit(
        [&]<class C>(const C& criterion) {
          for (int l = 0; l < el.blocks.used[size_t(block)]; ++l) {
            const SlotId slot(block * lanes + l);
            const size_t e = size_t(el.blocks.elem[slot]);
            double* memory = memory_.data() + e * C::memory;
            if (s.rigid.size() > 0 && s.rigid[slot] > 0) {
              values_[e] = 0;
              continue;
            }
            const Sample sample = sample_of(criterion, el, s, slot, eqps[l], skip_safe_, sigma_m, memory);
            looked_at_[size_t(block)] += sample.has_stress;
            values_[e] = criterion.fail(sample, memory);
            if (!strength_.empty()) values_[e] /= strength_[e];
          }
        },
        criteria_[size_t(body)]);
  });
  examined_ = std::accumulate(looked_at_.begin(), looked_at_.end(), examined_);
}

}  // namespace bw::csd
