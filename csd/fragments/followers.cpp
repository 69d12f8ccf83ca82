// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/followers.h"

#include <algorithm>

#include "common/parallel/loop.h"

namespace bw::csd {

void Followers::append(const std::vector<RigidBody>& bodies, size_t first, const Loads* loads,
                       std::vector<LeftFace> faces, const std::vector<int32_t>& body_at) {
  if (first == 0) *this = {};
  const auto body_of = [&](const LeftFace& face) { return body_at[size_t(face.nodes[0])]; };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const LeftFace& a, const LeftFace& b) { return body_of(a) < body_of(b); });
  auto face = faces.begin();
  for (size_t b = first; b < bodies.size(); ++b) {
    const RigidBody& body = bodies[b];
    const size_t begin = first_node_.back(), i = loaded_.size();
    for (size_t k = 0; loads && k < body.nodes().size(); ++k)
      if (const NodeId n = body.nodes()[k]; loads->is_loaded(n))
        nodes_.push_back({n, body.own_arm(k), loads->forces()[n]});
    const auto place = [&](NodeId n) {
      const auto it = std::lower_bound(nodes_.begin() + std::ptrdiff_t(begin), nodes_.end(), n,
                                       [](const Node& node, NodeId id) { return node.node < id; });
      return int32_t(it - nodes_.begin() - std::ptrdiff_t(begin));
    };
    for (; face != faces.end() && body_of(*face) == int32_t(b); ++face) {
      const auto& n = face->nodes;
      faces_.push_back({face->load, face->face, {place(n[0]), place(n[1]), place(n[2]), place(n[3])}});
    }
    first_node_.push_back(nodes_.size()), first_face_.push_back(faces_.size());
    const RigidBody::Push push = sum(body, i);
    if (first_face_[i] == first_face_[i + 1] && push.F == Vec3{} && push.T == Vec3{}) {
      fresh_.push_back(int32_t(b));
      nodes_.resize(begin), first_node_.pop_back(), first_face_.pop_back();
      continue;
    }
    loaded_.push_back(int32_t(b)), load_.push_back(push);
  }
}

void Followers::set_beside(const std::vector<RigidBody>& bodies, std::vector<NodeId> nodes,
                           const std::vector<int32_t>& body_at) {
  beside_.clear();
  for (const NodeId n : nodes) {
    const RigidBody& body = bodies[size_t(body_at[size_t(n)])];
    const auto it = std::lower_bound(body.nodes().begin(), body.nodes().end(), n);
    beside_.push_back({n, body.own_arm(size_t(it - body.nodes().begin())), body_at[size_t(n)]});
  }
}

RigidBody::Push Followers::sum(const RigidBody& body, size_t i) const {
  RigidBody::Push push;
  for (size_t k = first_node_[i]; k < first_node_[i + 1]; ++k) body.add(nodes_[k].arm, nodes_[k].f, push);
  return push;
}

void Followers::kick(std::vector<RigidBody>& bodies, double h) {
  power_ = parallel_sum(int64_t(loaded_.size()), [&](int64_t i) {
    RigidBody& body = bodies[size_t(loaded_[size_t(i)])];
    body.kick(h);
    return power_of(body, size_t(i));
  });
  parallel_for(int64_t(fresh_.size()), [&](int64_t i) { bodies[size_t(fresh_[size_t(i)])].kick(h); });
}

void Followers::place(const std::vector<RigidBody>& bodies, Field<Vec3, NodeId>& x) const {
  parallel_for(int64_t(beside_.size()), [&](int64_t i) {
    const Beside& b = beside_[size_t(i)];
    x[b.node] = bodies[size_t(b.body)].place_of(b.arm);
  });
}

void Followers::clear(Field<Vec3, NodeId>& f) const {
  parallel_for(int64_t(beside_.size()), [&](int64_t i) { f[beside_[size_t(i)].node] = {}; });
}

void Followers::take_forces(std::vector<RigidBody>& bodies, const Loads* loads) {
  power_ = parallel_sum(int64_t(loaded_.size()), [&](int64_t i) {
    RigidBody& body = bodies[size_t(loaded_[size_t(i)])];
    Node* const nodes = nodes_.data() + first_node_[size_t(i)];
    for (Node* node = nodes; node != nodes_.data() + first_node_[size_t(i) + 1]; ++node) node->f = {};
    for (size_t k = first_face_[size_t(i)]; k < first_face_[size_t(i) + 1]; ++k) {
      const OnBody& face = faces_[k];
      std::array<Vec3, 4> x;
      for (size_t a = 0; a < 4; ++a) x[a] = body.place_of(nodes[face.corner[a]].arm);
      loads->add_on_face(face.load, face.face, x, [&](size_t a) -> Vec3& { return nodes[face.corner[a]].f; });
    }
    body.take(load_[size_t(i)] = sum(body, size_t(i)));
    return power_of(body, size_t(i));
  });
  for (const int32_t b : fresh_) bodies[size_t(b)].take({});
  fresh_.clear();
}

void Followers::give_back(Loads& loads) const {
  for (const Node& node : nodes_) loads.forces()[node.node] = node.f;
}

}  // namespace bw::csd
