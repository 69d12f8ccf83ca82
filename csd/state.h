// SPDX-License-Identifier: Apache-2.0
// Everything that changes in time and belongs to no optional module. describe() names each field once.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/math/pack.h"
#include "csd/element/blocks.h"
#include "csd/element/stored_energy.h"
#include "csd/local_steps.h"
#include "csd/mesh/topology.h"
#include "csd/point_history.h"

namespace bw::csd {

struct State {
  double t = 0;          ///< s
  double dt = 0;         ///< s, last step
  double short_dt = 0;   ///< s, the shortest of its local steps; dt without such
  double dt_stable = 0;  ///< s, bound at t
  int64_t step = 0;

  Field<Vec3, NodeId> x, v;         ///< m, m/s, at t
  Field<Vec3, NodeId> f;            ///< N, all forces at t, after the conditions took theirs
  Field<double, NodeId> m;          ///< kg, lumped
  Field<PaddedPoint, NodeId> sums;  ///< N, work space of internal_force: zero between its calls

  Field<double, SlotId> V0;              ///< m^3, reference volume
  Field<double, SlotId> volume;          ///< m^3, current
  Field<double, SlotId> omega2;          ///< 1/s^2, centroid part of the bound on the largest eigenfrequency squared
  Field<double, SlotId> viscous_stress;  ///< Pa, bulk viscosity's part of the mean stress; empty without viscosity
  Field<double, SlotId> viscous_time;    ///< s, its viscosity over the stiffness; empty without viscosity
  Field<double, SlotId> collapsed;       ///< 1: a point has lost most of its volume (element/q1p0.h)
  Field<double, SlotId> rigid;           ///< 1: of a rigid body, passed over by the force loop; empty without such
  std::vector<PointHistory> history;     ///< [body]
  std::vector<StoredEnergy> of_rigid;    ///< [block] whose elements are all rigid, as they became so; empty without such

  LocalSteps local;                      ///< who is due now
  Field<PaddedPoint, NodeId> next_sums;  ///< N, work space: forces by the levels to come
  std::vector<int32_t> followed;         ///< nodes whose x, v, f are kept up to date on this rank; empty: all
  /// Those that are due.
  template <class Work>
  void for_nodes(const Work& work) const {
    if (const auto* due = local.due_nodes())
      parallel_for(int64_t(due->size()), [&](int64_t i) { work(NodeId((*due)[size_t(i)])); });
    else if (followed.empty())
      parallel_for(int64_t(m.size()), [&](int64_t n) { work(NodeId(n)); });
    else
      parallel_for(int64_t(followed.size()), [&](int64_t i) { work(NodeId(followed[size_t(i)])); });
  }

  enum Use { none = 0, output = 1, on_demand = 2 };  ///< on_demand: sized by the module that uses it
  /// visit(name, field, unit, use) for every field; Field<T, NodeId> are nodal, Field<T, SlotId> per element.
  template <class Visit>
  void describe(Visit&& visit) {
    visit("position", x, "m", none);
    visit("velocity", v, "m/s", output);
    visit("force", f, "N", none);
    visit("mass", m, "kg", none);
    visit("reference_volume", V0, "m^3", none);
    visit("volume", volume, "m^3", none);
    visit("omega2", omega2, "1/s^2", none);
    visit("viscous_stress", viscous_stress, "Pa", on_demand);
    visit("viscous_time", viscous_time, "s", on_demand);
    visit("collapsed", collapsed, "", output);
    visit("rigid", rigid, "", on_demand);
  }
  /// Makes room: nodal fields n, element fields slots.
  void resize(size_t nodes, size_t slots) {
    describe([&](const char*, auto& field, const char*, Use use) {
      if (use != on_demand) field.resize(is_nodal(field) ? nodes : slots);
    });
  }
  /// Every nodal field gets the parent's value at its end, split by split. Masses must then be summed anew.
  void append_copies(std::span<const NodeSplit> splits) {
    describe([&](const char*, auto& field, const char*, Use) {
      if constexpr (requires { field[NodeId(0)]; })
        for (const NodeSplit& split : splits) field.push_back(field[split.parent]);
    });
    local.append_copies(splits);
  }

 private:
  template <class T>
  static constexpr bool is_nodal(const Field<T, NodeId>&) {
    return true;
  }
  template <class T>
  static constexpr bool is_nodal(const Field<T, SlotId>&) {
    return false;
  }
};

}  // namespace bw::csd
