// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "common/app/error.h"
#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"

namespace bw::csd {

/// A spring and a dashpot at each node of a set, to where it stood at the start or to the nearest node of a second set;
/// unstrained at the start. The dashpot acts implicitly, as in damping.h.
struct Spring {
  static constexpr auto name = "spring";
  static constexpr bool is_pull = true;
  std::string nodes, to, place, place_to;
  double stiffness = 0, damping = 0;
  Vec3 direction{};
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set; each node has its own spring");
    k.optional("to", to, "name of a second node set: a spring leads to its nearest node; empty: to the ground");
    k.optional("stiffness", stiffness, dim::stiffness, "force over elongation, of each spring");
    k.optional("damping", damping, Dim{1, 0, -1, 0}, "force over velocity, of each dashpot");
    k.optional("direction", direction, dim::none,
               "springs act along it alone (of any length); (0, 0, 0): alike in all directions");
    k.expect(stiffness >= 0, "stiffness", "a number >= 0");
    k.expect(damping >= 0, "damping", "a number >= 0");
    k.expect(stiffness > 0 || damping > 0, "stiffness", "a stiffness or a damping > 0");
    if (!k.is_manual()) place = k.where("nodes"), place_to = k.where("to");
    if (norm(direction) > 0) direction = unit(direction);
  }
  void select(const Mesh& mesh) {
    std::vector<NodeId> set = node_set(mesh, nodes, place);
    count_ = set.size();
    if (!to.empty()) {
      const auto& others = node_set(mesh, to, place_to);
      for (size_t i = 0; i < count_; ++i) set.push_back(nearest(mesh, others, set[i]));
    }
    reaction.renew(set, size_t(mesh.node_count()));
    start_.clear();
    for (size_t i = 0; i < count_; ++i)
      start_.push_back(to.empty() ? mesh.X[set[i]] : mesh.X[set[i]] - mesh.X[set[count_ + i]]);
  }
  void before_drift(State&, double) {}
  void on_force(State& s, double dt) {
    const double h = 0.5 * dt;
    for (size_t i = 0; i < count_; ++i) {
      const NodeId a = reaction.nodes[i];
      const bool is_pair = !to.empty();
      const NodeId b = is_pair ? reaction.nodes[count_ + i] : a;
      const Vec3 u = along(s.x[a] - (is_pair ? s.x[b] : Vec3{}) - start_[i]);
      const Vec3 v = along(s.v[a] - (is_pair ? s.v[b] : Vec3{}));
      const Vec3 a_rel = along((1 / s.m[a]) * s.f[a] - (is_pair ? (1 / s.m[b]) * s.f[b] : Vec3{}));
      const double inverse_mass = 1 / s.m[a] + (is_pair ? 1 / s.m[b] : 0);
      const Vec3 pull = stiffness * u;
      const Vec3 v_end = (1 / (1 + h * damping * inverse_mass)) * (v + h * (a_rel - inverse_mass * pull));
      const Vec3 force = pull + damping * v_end;
      reaction.take_force(s, i, force, dt);
      if (is_pair) reaction.take_force(s, count_ + i, -force, dt);
    }
  }
  void after_kick(State&, double) {}
  /// Bound of the square of the springs' own largest frequency [1/s^2], to be added to the elements' (Gershgorin).
  double omega2(const State& s) const {
    std::vector<double> sum(s.x.size());
    double worst = 0;
    for (NodeId n : reaction.nodes)
      if (s.m[n] > 0) worst = std::max(worst, sum[size_t(n)] += (to.empty() ? 1 : 2) * stiffness / s.m[n]);
    return worst;
  }

 private:
  Vec3 along(const Vec3& a) const { return norm(direction) > 0 ? dot(a, direction) * direction : a; }
  NodeId nearest(const Mesh& mesh, const std::vector<NodeId>& others, NodeId a) const {
    NodeId best;
    for (NodeId b : others)
      if (b != a && (!best.valid() || norm(mesh.X[b] - mesh.X[a]) < norm(mesh.X[best] - mesh.X[a]))) best = b;
    if (!best.valid()) throw InputError(fmt::format("{}: the set \"{}\" has no other node", place_to, to));
    return best;
  }
  size_t count_ = 0;         // springs
  std::vector<Vec3> start_;  // m: place, or difference of places
};

}  // namespace bw::csd
