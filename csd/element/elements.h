// SPDX-License-Identifier: Apache-2.0
// All elements of the model: blocks and the material of each body, and the loops over them.
#pragma once
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "csd/element/blocks.h"
#include "csd/element/resting.h"
#include "csd/material/list.h"
#include "csd/ranks/ranks.h"
#include "csd/state.h"

namespace bw::csd {

struct Elements {
  Blocks blocks;
  std::vector<Materials> materials;  ///< [body]
  std::vector<double> mass_factor;   ///< [element] of mass scaling; empty: 1
  bool skip_elastic = true;          ///< pass over work that only flow needs (Skips)
  bool single_history = false;       ///< see PointHistory

  int body_of(SlotId slot) const;

  std::shared_ptr<Ranks> ranks;  ///< null on one rank
  /// Nodal sums over this rank's elements become those over all: after each loop that adds to nodes.
  template <class T>
  void finish_sum(Field<T, NodeId>& a) const {
    if (ranks) ranks->sum(blocks, a);
  }
};

/// Fold of value(slot) over all elements in their order, the same on all ranks. T holds doubles.
template <class T, class Value, class Combine>
T reduce_elements(const Elements& el, const T& identity, const Value& value, const Combine& combine) {
  const Field<SlotId, ElemId>& slot = el.blocks.slot;
  const auto of = [&](int64_t e) { return value(slot[ElemId(e)]); };
  if (!el.ranks) return parallel_reduce_stored(int64_t(slot.size()), identity, of, combine);
  std::vector<T> values(slot.size());
  parallel_for(int64_t(slot.size()), [&](int64_t e) {
    if (el.blocks.is_own(slot[ElemId(e)])) values[size_t(e)] = of(e);
  });
  el.ranks->complete(values);
  return parallel_reduce(
      int64_t(values.size()), identity, [&](int64_t e) { return values[size_t(e)]; }, combine);
}
template <class Value>
double sum_elements(const Elements& el, const Value& value) {
  return reduce_elements(el, 0.0, value, [](double a, double b) { return a + b; });
}

/// Bulk viscosity: on compression sigma_m gains rho h (c1 c_L + c2 h |rate|) rate, h = cube root of the volume.
struct BulkViscosity {
  double linear = 0, quadratic = 0;
  bool on() const { return linear > 0 || quadratic > 0; }
};

/// What the mean stress of the next forces is made of besides U'(v_e/V_e).
struct MeanStress {
  const Field<double, SlotId>* given = nullptr;  ///< Pa, replaces U' (a filtered pressure); null: U'
  BulkViscosity viscosity;
  double dt = 0;  ///< s, the shortest step since State::volume was taken and flow was last committed, for rates
};

/// Fills State and the corner masses from the mesh: fields sized, reference volumes, history, lumped masses, x = X, v =
/// 0. InputError naming the element if a reference volume (or its determinant at a point) is not positive.
void start(const Mesh& mesh, Elements& elements, State& s);

/// s.f = internal forces; new history, volume, omega2 and collapsed. Returns the work spent in viscosity since the last
/// call [J]. With a reference, blocks at rest bear no force. Only what is due: a block of local steps bears on its nodes
/// by its own step over theirs.
double internal_force(const Elements& elements, const MeanStress& mean_stress, State& s,
                      const Reference* reference = nullptr);
/// s.f = the same by the levels to come, after State::local took them: those were pending at the last call.
void take_next_sums(State& s);

/// Row sums of rho_0 N_a [kg] over an element (VALIDATION A.3), from the reference positions of its nodes.
std::array<double, 8> corner_masses(const Mesh& mesh, const Elements& elements, ElemId e);
/// Lumped mass of a node [kg]: its share of the elements given, which must ascend, so that it has one value.
double node_mass(const Mesh& mesh, const Elements& elements, std::span<const ElemId> around, NodeId n);

}  // namespace bw::csd
