// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"

namespace bw::csd {

/// Nodes that don't move.
struct Fixed {
  static constexpr auto name = "fixed";
  std::string nodes, place;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set");
    if (!k.is_manual()) place = k.where("nodes");
  }
  void select(const Mesh& mesh) { reaction.renew(node_set(mesh, nodes, place), size_t(mesh.node_count())); }
  void before_drift(State& s, double dt) {
    reaction.for_due(s, dt, [&](size_t, NodeId n, double) { reaction.set_velocity(s, n, {}); });
  }
  void on_force(State& s, double dt) {
    reaction.for_due(s, dt, [&](size_t i, NodeId n, double h) { reaction.take_force(s, i, s.f[n], h); });
  }
  void after_kick(State&, double) {}
};

/// What holds nodes on planes of one normal.
struct OnPlane {
  Vec3 normal{};
  Reaction reaction;

  void before_drift(State& s, double dt) {
    reaction.for_due(
        s, dt, [&](size_t, NodeId n, double) { reaction.set_velocity(s, n, s.v[n] - dot(normal, s.v[n]) * normal); });
  }
  void on_force(State& s, double dt) {
    reaction.for_due(s, dt,
                     [&](size_t i, NodeId n, double h) { reaction.take_force(s, i, dot(normal, s.f[n]) * normal, h); });
  }
  void after_kick(State&, double) {}
};

/// Nodes that slide on a plane.
struct Roller : OnPlane {
  static constexpr auto name = "roller";
  std::string nodes, place;

  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set");
    k.required("normal", normal, dim::none, "direction in which the nodes can't move (of any length)");
    k.expect(norm(normal) > 0, "normal", "a direction other than (0, 0, 0)");
    if (!k.is_manual()) place = k.where("nodes"), normal = unit(normal);
  }
  void select(const Mesh& mesh) { reaction.renew(node_set(mesh, nodes, place), size_t(mesh.node_count())); }
};

}  // namespace bw::csd
