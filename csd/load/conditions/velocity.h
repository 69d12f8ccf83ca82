// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

/// Nodes with a prescribed velocity: value, times a factor by time.
struct PrescribedVelocity {
  static constexpr auto name = "velocity";
  std::string nodes, components = "xyz", place;
  Vec3 value{};
  std::optional<Table> factor;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set");
    k.required("value", value, dim::velocity, "velocity of the nodes");
    k.choice("components", components, {"x", "y", "z", "xy", "xz", "yz", "xyz"},
             "which components are prescribed; the others are free");
    describe_factor(k, factor);
    if (!k.is_manual()) place = k.where("nodes");
  }
  void select(const Mesh& mesh) { reaction.renew(node_set(mesh, nodes, place), size_t(mesh.node_count())); }
  void before_drift(State& s, double dt) {
    reaction.for_due(
        s, dt, [&](double h) { return at(s.t + 0.5 * h); },
        [&](size_t, NodeId n, double, const Vec3& v) { impose(s, n, v); });
  }
  void on_force(State& s, double dt) {
    reaction.for_due(s, dt,
                     [&](size_t i, NodeId n, double h) { reaction.take_force(s, i, prescribed(s.f[n], {}), h); });
  }
  void after_kick(State& s, double dt) {
    const Vec3 v = at(s.t + dt);
    reaction.for_due(s, dt, [&](size_t, NodeId n, double) { impose(s, n, v); });
  }

 private:
  /// The prescribed components from a, the others from b.
  Vec3 prescribed(const Vec3& a, const Vec3& b) const {
    const auto has = [&](char c) { return components.find(c) != std::string::npos; };
    return {has('x') ? a.x : b.x, has('y') ? a.y : b.y, has('z') ? a.z : b.z};
  }
  Vec3 at(double t) const { return (factor ? factor->at(t) : 1.0) * value; }
  void impose(State& s, NodeId n, const Vec3& v) { reaction.set_velocity(s, n, prescribed(v, s.v[n])); }
};

}  // namespace bw::csd
