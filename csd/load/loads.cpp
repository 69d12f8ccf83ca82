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
  for (const auto& [n, f] : given_) f_[n] += f;
  parallel_for(int64_t(f_.size()), [&](int64_t n) { s.f[NodeId(n)] += f_[NodeId(n)]; });
}

double Loads::power(const State& s) const {
  return parallel_sum(int64_t(f_.size()), [&](int64_t n) { return dot(f_[NodeId(n)], s.v[NodeId(n)]); });
}

void Loads::replace_given(std::vector<std::pair<NodeId, Vec3>> forces, State& s) {
  for (const auto& [n, f] : given_) f_[n] -= f, s.f[n] -= f;
  given_ = std::move(forces);
  for (const auto& [n, f] : given_) f_[n] += f, s.f[n] += f;
}

}  // namespace bw::csd
