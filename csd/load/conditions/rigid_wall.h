// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <optional>
#include <string>

#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

/// A rigid plane that no node crosses. A node that would is put on it and loses its normal velocity: an inelastic
/// impact of the lumped mass, whose energy is booked. It stays while its body as a whole moves towards the plane;
/// afterwards it leaves when it is pulled. (The published Taylor bars hold the foot on the wall, VALIDATION S7; free to
/// lift, its rim curls up.) It may move, with a velocity that a table varies in time. Nodes of rigid bodies are not its
/// affair: the bodies meet it as a whole (csd/fragments/impact.h).
struct RigidWall {
  static constexpr auto name = "rigid_wall";
  Vec3 point{}, normal{}, velocity{};
  std::string friction = "none", separation = "rebound", nodes, place;
  double coefficient = 0.1, restitution = 0;
  std::optional<Table> factor;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "a point of the plane");
    k.required("normal", normal, dim::none, "of the plane, into the half space where the nodes are (of any length)");
    k.choice("friction", friction, {"none", "stick", "coulomb"},
             "none: nodes slide freely; stick: nodes in contact don't slide; coulomb: they slide once the force along "
             "the wall exceeds `coefficient` times the force on it");
    k.optional("coefficient", coefficient, dim::none, "of Coulomb's friction");
    k.expect(coefficient >= 0, "coefficient", "a number >= 0");
    k.choice("separation", separation, {"rebound", "node"},
             "rebound: nodes in contact stay while their body's momentum leads to the wall, then each leaves when it "
             "is pulled; "
             "node: each leaves when it is pulled, from the start");
    k.optional("restitution", restitution, dim::none,
               "of rigid bodies: normal velocity of a point after its impact over that before; at most 1. Deformable "
               "bodies bounce by their own stiffness");
    k.expect(restitution >= 0 && restitution <= 1, "restitution", "a number from 0 to 1");
    k.optional("velocity", velocity, dim::velocity, "of the wall, times `factor`");
    describe_factor(k, factor);
    k.optional("nodes", nodes, "name of the node set that the wall stops; empty: all nodes");
    k.expect(norm(normal) > 0, "normal", "a direction other than (0, 0, 0)");
    if (!k.is_manual()) place = k.where("nodes"), normal = unit(normal);
  }
  void select(const Mesh& mesh) {
    std::vector<NodeId> set;
    for (int n = 0; n < mesh.node_count(); ++n) set.push_back(NodeId(n));
    if (!nodes.empty()) {
      set = node_set(mesh, nodes, place);
      is_stopped_.assign(size_t(mesh.node_count()), 0);
      for (NodeId n : set) is_stopped_[size_t(n)] = 1;
    }
    std::vector<char> at(size_t(mesh.node_count()), 0);
    for (size_t i = 0; i < reaction.nodes.size(); ++i) at[size_t(reaction.nodes[i])] = touches_[i];
    body_.assign(size_t(mesh.node_count()), 0);
    for (int e = 0; e < mesh.elem_count(); ++e)
      for (NodeId n : mesh.hex[ElemId(e)]) body_[size_t(n)] = mesh.body[ElemId(e)];
    touches_.clear();
    for (NodeId n : set) {
      const NodeId parent = mesh.parent[n];  // a node born on the wall stays on it
      touches_.push_back(at[size_t(n)] || (parent.valid() && at[size_t(parent)]));
    }
    momentum_.assign(size_t(*std::max_element(body_.begin(), body_.end())) + 1, 0);
    reaction.renew(set, size_t(mesh.node_count()));
  }
  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.value("point", point), a.value("moves", w_);
    a.list("touches", touches_), a.list("left", is_left_);
  }
  /// Nodes of rigid bodies [node], from now on; later nodes are none.
  void leave(const std::vector<char>& is_rigid) { is_left_ = is_rigid; }
  bool stops(NodeId n) const { return is_stopped_.empty() || is_stopped_[size_t(n)]; }
  const Vec3& moves() const { return w_; }  ///< m/s, in the present step

  void before_drift(State& s, double dt) {
    w_ = (factor ? factor->at(s.t + 0.5 * dt) : 1.0) * velocity;
    reaction.for_due(s, dt, [&](size_t i, NodeId n, double h) {
      if (is_left(n)) return;
      const Vec3 v = s.v[n] - w_;
      const double gap = dot(s.x[n] - point, normal), v_n = dot(v, normal);
      if (gap + h * v_n >= 0) return;
      touches_[i] = 1;
      reaction.set_velocity(s, n, w_ + ((-gap / h) * normal + sliding(v, -v_n)));  // ends on the plane
    });
  }
  void on_force(State& s, double dt) {
    point += dt * w_;
    if (s.local.all_due()) sum_momenta(s);
    reaction.for_due(s, dt, [&](size_t i, NodeId n, double h) {
      if (is_left(n)) touches_[i] = 0, reaction.R[i] = {};
      if (!touches_[i]) return;
      const double f_n = dot(s.f[n], normal);
      touches_[i] = f_n < 0 || (separation == "rebound" && momentum_[size_t(body_[size_t(n)])] < 0);
      reaction.take_force(s, i, !touches_[i] ? Vec3{} : held(s, n, f_n, h), h);
      if (touches_[i]) reaction.set_velocity(s, n, w_ + (friction == "stick" ? Vec3{} : along(s.v[n] - w_)));
    });
  }
  void after_kick(State&, double) {}

 private:
  void sum_momenta(const State& s) {
    std::fill(momentum_.begin(), momentum_.end(), 0);
    for (size_t n = 0; n < body_.size(); ++n)
      if (!is_left(NodeId(int64_t(n))))
        momentum_[size_t(body_[n])] += s.m[NodeId(int64_t(n))] * dot(s.v[NodeId(int64_t(n))] - w_, normal);
  }
  bool is_left(NodeId n) const { return size_t(n) < is_left_.size() && is_left_[size_t(n)]; }
  Vec3 along(const Vec3& v) const { return v - dot(v, normal) * normal; }
  /// The largest part of `wish` that friction allows for `pressing`, impulses or forces alike.
  Vec3 limited(const Vec3& wish, double pressing) const {
    const double size = norm(wish), limit = coefficient * std::max(pressing, 0.0);
    return size > limit ? (limit / size) * wish : wish;
  }
  /// Velocity along the wall after an impact that takes `stopped` of the normal velocity.
  Vec3 sliding(const Vec3& v, double stopped) const {
    if (friction == "stick") return {};
    return friction == "none" ? along(v) : along(v) - limited(along(v), stopped);
  }
  /// What the wall takes of a touching node's force: the normal part, and what holds it back along the wall. Coulomb:
  /// at most what stops it within the step.
  Vec3 held(const State& s, NodeId n, double f_n, double dt) const {
    if (friction == "stick") return s.f[n];
    if (friction == "none" || dt == 0) return f_n * normal;
    return f_n * normal + limited(along(s.f[n] + (s.m[n] / dt) * (s.v[n] - w_)), -f_n);
  }
  Vec3 w_;                        // m/s, of the wall in the present step
  std::vector<char> touches_;     // per reaction.nodes
  std::vector<char> is_stopped_;  // per node; empty: all
  std::vector<char> is_left_;     // per node: of a rigid body
  std::vector<int32_t> body_;     // per node
  std::vector<double> momentum_;  // kg m/s along the normal, per body
};

}  // namespace bw::csd
