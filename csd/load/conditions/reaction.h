// SPDX-License-Identifier: Apache-2.0
// What a condition does to its nodes, and the books of it.
#pragma once
#include <vector>

#include "csd/state.h"

namespace bw::csd {

/// The forces R that a condition puts on its nodes, its impulses, and the energy it brings in.
struct Reaction {
  std::vector<NodeId> nodes;
  std::vector<Vec3> R;  ///< N, at s.t
  Vec3 impulse;         ///< N s, on the nodes during the last step
  double work = 0;      ///< J, since the start; kinetic energy lost in impacts is negative work

  void renew(const std::vector<NodeId>& set, size_t node_count) {
    std::vector<Vec3> at(node_count);
    for (size_t i = 0; i < nodes.size(); ++i) at[size_t(nodes[i])] = R[i];
    nodes = set;
    R.clear();
    for (NodeId n : nodes) R.push_back(at[size_t(n)]);
  }
  /// In a checkpoint; the nodes follow from the mesh.
  template <class A>
  void keep(A& a) {
    a.list("R", R), a.value("impulse", impulse), a.value("work", work);
  }
  /// work(i, n, h) for the nodes that are due, h: the node's step where the shortest is dt.
  template <class Work>
  void for_due(const State& s, double dt, const Work& work) const {
    for (size_t i = 0; i < nodes.size(); ++i)
      if (s.local.is_due(nodes[i])) work(i, nodes[i], dt * s.local.steps_of(nodes[i]));
  }
  /// The same with value(h) as work's last argument, found anew only where h differs from the node before.
  template <class Value, class Work>
  void for_due(const State& s, double dt, const Value& value, const Work& work) const {
    double known_h = dt;
    auto known = value(dt);
    for_due(s, dt, [&](size_t i, NodeId n, double h) {
      if (h != known_h) known_h = h, known = value(h);
      work(i, n, h, known);
    });
  }
  /// Undoes take_force: the forces change within the step.
  void give_back(State& s) {
    for (size_t i = 0; i < nodes.size(); ++i) s.f[nodes[i]] -= R[i], R[i] = {};
  }
  /// Velocity of a node jumps to v.
  void set_velocity(State& s, NodeId n, const Vec3& v) {
    const Vec3 dv = v - s.v[n];
    impulse += s.m[n] * dv;
    work += 0.5 * s.m[n] * dot(dv, v + s.v[n]);
    s.v[n] = v;
  }
  /// The i-th node's force loses `taken` (what it gets from the condition is -taken). s.v: its velocity during the step
  /// dt.
  void take_force(State& s, size_t i, const Vec3& taken, double dt) {
    const Vec3 mean = 0.5 * dt * (R[i] - taken);
    impulse += mean;
    work += dot(mean, s.v[nodes[i]]);
    R[i] = -taken;
    s.f[nodes[i]] -= taken;
  }
};

}  // namespace bw::csd
