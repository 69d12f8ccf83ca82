// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <string>

#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"

namespace bw::csd {

/// Force -c v at the step's end, for the velocity that it brings about itself: v = (v_half + h f/m) / (1 + h c/m), h =
/// dt/2. So the whole is central differences with v^n = (v^(n-1/2) + v^(n+1/2))/2, stable for any c.
inline Vec3 damping_force(const State& s, NodeId n, double rate, double dt) {
  const double h = 0.5 * dt;
  return (-rate / (1 + h * rate)) * (s.m[n] * s.v[n] + h * s.f[n]);
}

/// Drag in proportion to mass: the acceleration -rate v. It acts last, on what the other conditions leave.
struct Damping {
  static constexpr auto name = "damping";
  static constexpr bool is_last = true;
  double rate = 0, until = 1e300;
  std::string nodes, place;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("rate", rate, dim::frequency,
               "acceleration -rate v; 2 omega damps a mode of the angular frequency omega critically");
    k.optional("until", until, dim::time, "when it ends; not given: never");
    k.optional("nodes", nodes, "name of the node set; empty: all nodes");
    k.expect(rate >= 0, "rate", "a number >= 0 per time");
    if (!k.is_manual()) place = k.where("rate");
  }
  void select(const Mesh& mesh) {
    std::vector<NodeId> set;
    for (int n = 0; nodes.empty() && n < mesh.node_count(); ++n) set.push_back(NodeId(n));
    reaction.renew(nodes.empty() ? set : node_set(mesh, nodes, place), size_t(mesh.node_count()));
  }
  void before_drift(State&, double) {}
  void on_force(State& s, double dt) {
    const double c = s.t + dt > until ? 0 : rate;
    reaction.for_due(s, dt, [&](size_t i, NodeId n, double h) {
      if (s.m[n] > 0) reaction.take_force(s, i, -damping_force(s, n, c, h), h);
    });
  }
  void after_kick(State&, double) {}
};

}  // namespace bw::csd
