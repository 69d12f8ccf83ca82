// SPDX-License-Identifier: Apache-2.0
// The nodes' part of central differences, eq (14).
#pragma once
#include "common/parallel/loop.h"
#include "csd/state.h"

namespace bw::csd {

/// v += h f/m: eqs (14), (15), of nodes that are due; h of the shortest steps. Nodes without mass (of no element) stay.
inline void kick(State& s, double h) {
  s.for_nodes([&](NodeId n) {
    if (s.m[n] > 0) s.v[n] += (h * s.local.steps_of(n) / s.m[n]) * s.f[n];
  });
}

inline void drift(State& s, double dt) {
  s.for_nodes([&](NodeId n) { s.x[n] += dt * s.local.steps_of(n) * s.v[n]; });
}

}  // namespace bw::csd
