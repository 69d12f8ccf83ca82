// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/units.h"
#include "common/parallel/loop.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// A constant acceleration of all mass.
struct Gravity {
  static constexpr auto name = "gravity";
  Vec3 acceleration{0, 0, -9.80665};

  template <class K>
  void describe(K& k) {
    k.optional("acceleration", acceleration, dim::acceleration, "of free fall");
  }

  void select(const Mesh&) {}
  void add(const Mesh&, const Field<Vec3, NodeId>&, const Field<double, NodeId>& m, double,
           Field<Vec3, NodeId>& f) const {
    parallel_for(int64_t(f.size()), [&](int64_t n) { f[NodeId(n)] += m[NodeId(n)] * acceleration; });
  }
};

}  // namespace bw::csd
