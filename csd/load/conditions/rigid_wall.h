// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <string>

#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"

namespace bw::csd {

/// A rigid plane that no node crosses. A node that would is put on it and loses its normal velocity: an inelastic impact of the
/// lumped mass, whose energy is booked. It leaves when its body as a whole no longer presses on the plane, or, on demand,
/// as soon as it is pulled itself. (The published Taylor bars hold the foot on the wall: VALIDATION S7.)
struct RigidWall {
  static constexpr auto name = "rigid_wall";
  Vec3 point{}, normal{};
  std::string friction = "none", separation = "body", nodes, place;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "a point of the plane");
    k.required("normal", normal, dim::none, "of the plane, into the half space where the nodes are (of any length)");
    k.choice("friction", friction, {"none", "stick"}, "none: nodes slide freely; stick: nodes in contact don't slide");
    k.choice("separation", separation, {"body", "node"},
             "body: nodes in contact leave together, when the wall's force on their body would be a pull; node: each leaves when it is pulled");
    k.optional("nodes", nodes, "name of the node set that the wall stops; empty: all nodes");
    k.expect(norm(normal) > 0, "normal", "a direction other than (0, 0, 0)");
    if (!k.is_manual()) place = k.where("nodes"), normal = unit(normal);
  }
  void select(const Mesh& mesh) {
    std::vector<NodeId> set;
    for (int n = 0; n < mesh.node_count(); ++n) set.push_back(NodeId(n));
    if (!nodes.empty()) set = node_set(mesh, nodes, place);
    std::vector<char> at(size_t(mesh.node_count()), 0);
    for (size_t i = 0; i < reaction.nodes.size(); ++i) at[size_t(reaction.nodes[i])] = touches_[i];
    std::vector<int32_t> body(size_t(mesh.node_count()), 0);
    for (int e = 0; e < mesh.elem_count(); ++e)
      for (NodeId n : mesh.hex[ElemId(e)]) body[size_t(n)] = mesh.body[ElemId(e)];
    touches_.clear(), body_.clear();
    for (NodeId n : set) {
      const NodeId parent = mesh.parent[n];  // a node born on the wall stays on it
      touches_.push_back(at[size_t(n)] || (parent.valid() && at[size_t(parent)]));
      body_.push_back(body[size_t(n)]);
    }
    press_.assign(size_t(*std::max_element(body.begin(), body.end())) + 1, 0);
    reaction.renew(set, size_t(mesh.node_count()));
  }
  void before_drift(State& s, double dt) {
    for (size_t i = 0; i < reaction.nodes.size(); ++i) {
      const NodeId n = reaction.nodes[i];
      const double gap = dot(s.x[n] - point, normal), v_n = dot(s.v[n], normal);
      if (gap + dt * v_n >= 0) continue;
      touches_[i] = 1;
      reaction.set_velocity(s, n, (-gap / dt) * normal + sliding(s.v[n]));  // ends on the plane
    }
  }
  void on_force(State& s, double dt) {
    std::fill(press_.begin(), press_.end(), 0);
    for (size_t i = 0; i < reaction.nodes.size(); ++i)
      if (touches_[i]) press_[size_t(body_[i])] -= dot(s.f[reaction.nodes[i]], normal);
    for (size_t i = 0; i < reaction.nodes.size(); ++i) {
      if (!touches_[i]) continue;
      const NodeId n = reaction.nodes[i];
      const double f_n = dot(s.f[n], normal);
      touches_[i] = separation == "node" ? f_n < 0 : press_[size_t(body_[i])] > 0;
      reaction.take_force(s, i, !touches_[i] ? Vec3{} : friction == "stick" ? s.f[n] : f_n * normal, dt);
      if (touches_[i]) reaction.set_velocity(s, n, sliding(s.v[n]));
    }
  }
  void after_kick(State&, double) {}

 private:
  Vec3 sliding(const Vec3& v) const { return friction == "stick" ? Vec3{} : v - dot(v, normal) * normal; }
  std::vector<char> touches_;   // per reaction.nodes
  std::vector<int32_t> body_;   // per reaction.nodes
  std::vector<double> press_;   // N, per body
};

}  // namespace bw::csd
