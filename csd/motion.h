// SPDX-License-Identifier: Apache-2.0
// The nodes' part of central differences, eq (14).
#pragma once
#include "common/parallel/loop.h"
#include "csd/state.h"

namespace bw::csd {

/// v += h f/m: eqs (14), (15). Nodes without mass (of no element) stay.
inline void kick(State& s, double h) {
  parallel_for(int64_t(s.v.size()), [&](int64_t i) {
    const NodeId n(i);
    if (s.m[n] > 0) s.v[n] += (h / s.m[n]) * s.f[n];
  });
}

inline void drift(State& s, double dt) {
  parallel_for(int64_t(s.x.size()), [&](int64_t i) { s.x[NodeId(i)] += dt * s.v[NodeId(i)]; });
}

}  // namespace bw::csd
