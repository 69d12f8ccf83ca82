// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/followers.h"

#include <algorithm>

#include "common/parallel/loop.h"

namespace bw::csd {

void Followers::append(const std::vector<RigidBody>& bodies, size_t first, const Loads* loads) {
  if (first == 0) *this = {};
  for (size_t b = first; b < bodies.size(); ++b) {
    const RigidBody& body = bodies[b];
    if (loads)
      for (size_t i = 0; i < body.nodes().size(); ++i)
        if (loads->is_loaded(body.nodes()[i])) nodes_.push_back({body.nodes()[i], body.own_arm(i)});
    if (nodes_.size() == first_.back()) {
      fresh_.push_back(int32_t(b));
      continue;
    }
    loaded_.push_back(int32_t(b)), first_.push_back(nodes_.size());
    load_.push_back(sum(body, loaded_.size() - 1, *loads));
  }
}

void Followers::set_beside(const std::vector<RigidBody>& bodies, std::vector<NodeId> nodes,
                           const std::vector<int32_t>& body_at) {
  beside_.clear();
  for (const NodeId n : nodes) {
    const RigidBody& body = bodies[size_t(body_at[size_t(n)])];
    const auto it = std::lower_bound(body.nodes().begin(), body.nodes().end(), n);
    beside_.push_back({{n, body.own_arm(size_t(it - body.nodes().begin()))}, body_at[size_t(n)]});
  }
}

RigidBody::Push Followers::sum(const RigidBody& body, size_t i, const Loads& loads) const {
  RigidBody::Push push;
  for (size_t k = first_[i]; k < first_[i + 1]; ++k) body.add(nodes_[k].arm, loads.forces()[nodes_[k].node], push);
  return push;
}

void Followers::kick(std::vector<RigidBody>& bodies, double h) {
  const auto kick_all = [&](const std::vector<int32_t>& places) {
    parallel_for(int64_t(places.size()), [&](int64_t i) { bodies[size_t(places[size_t(i)])].kick(h); });
  };
  kick_all(loaded_), kick_all(fresh_);
}

void Followers::place(const std::vector<RigidBody>& bodies, Field<Vec3, NodeId>& x) const {
  parallel_for(int64_t(loaded_.size()), [&](int64_t i) {
    const RigidBody& body = bodies[size_t(loaded_[size_t(i)])];
    for (size_t k = first_[size_t(i)]; k < first_[size_t(i) + 1]; ++k) x[nodes_[k].node] = body.place_of(nodes_[k].arm);
  });
  parallel_for(int64_t(beside_.size()), [&](int64_t i) {
    const Beside& b = beside_[size_t(i)];
    x[b.at.node] = bodies[size_t(b.body)].place_of(b.at.arm);
  });
}

void Followers::clear(Field<Vec3, NodeId>& f) const {
  parallel_for(int64_t(beside_.size()), [&](int64_t i) { f[beside_[size_t(i)].at.node] = {}; });
}

void Followers::take_forces(std::vector<RigidBody>& bodies, const Loads* loads) {
  parallel_for(int64_t(loaded_.size()), [&](int64_t i) {
    RigidBody& body = bodies[size_t(loaded_[size_t(i)])];
    body.take(load_[size_t(i)] = sum(body, size_t(i), *loads));
  });
  for (const int32_t b : fresh_) bodies[size_t(b)].take({});
  fresh_.clear();
}

double Followers::power(const std::vector<RigidBody>& bodies) const {
  return parallel_sum(int64_t(loaded_.size()), [&](int64_t i) {
    const RigidBody& body = bodies[size_t(loaded_[size_t(i)])];
    return dot(load_[size_t(i)].F, body.velocity()) + dot(load_[size_t(i)].T, body.spin());
  });
}

}  // namespace bw::csd
