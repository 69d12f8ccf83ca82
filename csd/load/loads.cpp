// SPDX-License-Identifier: Apache-2.0
#include "csd/load/loads.h"

#include "common/parallel/loop.h"

namespace bw::csd {

Loads::Loads(const Mesh& mesh, std::vector<LoadKind> kinds) : kinds_(std::move(kinds)), f_(size_t(mesh.node_count())) {
  for (auto& kind : kinds_) std::visit([&](auto& load) { load.select(mesh); }, kind);
}

void Loads::add(const Mesh& mesh, double t, State& s) {
  parallel_for(int64_t(f_.size()), [&](int64_t n) { f_[NodeId(n)] = {}; });
  for (const auto& kind : kinds_) std::visit([&](const auto& load) { load.add(mesh, s.x, s.m, t, f_); }, kind);
  add_given(mesh);
  parallel_for(int64_t(f_.size()), [&](int64_t n) { s.f[NodeId(n)] += f_[NodeId(n)]; });
}

double Loads::power(const State& s) const {
  return parallel_sum(int64_t(f_.size()), [&](int64_t n) { return dot(f_[NodeId(n)], s.v[NodeId(n)]); });
}

void Loads::add_given(const Mesh& mesh) {
  for (const auto& [face, f] : given_)
    for (NodeId n : mesh.nodes_of(face)) f_[n] += 0.25 * f;
}

void Loads::replace_given(const Mesh& mesh, std::vector<std::pair<Face, Vec3>> forces, State& s) {
  for (size_t n = 0; n < f_.size(); ++n) s.f[NodeId(int64_t(n))] -= f_[NodeId(int64_t(n))];
  given_ = std::move(forces);
  add(mesh, s.t, s);
}

void Loads::append_copies(std::span<const NodeSplit> splits) {
  for (const NodeSplit& split : splits) f_.push_back(f_[split.parent]);
}

}  // namespace bw::csd
