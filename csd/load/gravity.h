// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "common/parallel/loop.h"
#include "csd/load/table.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// An acceleration of all mass.
struct Gravity {
  static constexpr auto name = "gravity";
  Vec3 acceleration{0, 0, -9.80665};
  std::optional<Table> factor;

  template <class K>
  void describe(K& k) {
    k.optional("acceleration", acceleration, dim::acceleration, "of free fall");
    describe_factor(k, factor);
  }

  void select(const Mesh&) {}
  void add(const Mesh&, const Field<Vec3, NodeId>&, const Field<double, NodeId>& m, double t,
           Field<Vec3, NodeId>& f) const {
    const Vec3 now = (factor ? factor->at(t) : 1.0) * acceleration;
    parallel_for(int64_t(f.size()), [&](int64_t n) { f[NodeId(n)] += m[NodeId(n)] * now; });
  }
};

}  // namespace bw::csd
