// SPDX-License-Identifier: Apache-2.0
#include "csd/load/loads.h"

#include <algorithm>

#include "common/app/error.h"
#include "common/parallel/loop.h"

namespace bw::csd {

std::vector<NodeId> nodes_of_load(const Mesh& mesh, const LoadKind& load) {
  return std::visit(
      [&](const auto& l) {
        std::vector<NodeId> nodes;
        if constexpr (requires { l.faces; }) {
          nodes = nodes_of_faces(mesh, face_sets(mesh, l.faces, l.place));
        } else {
          if constexpr (requires { l.elements; })
            if (!l.elements.empty()) {
              for (const ElemId e : elem_set(mesh, l.elements, l.place))
                nodes.insert(nodes.end(), mesh.hex[e].begin(), mesh.hex[e].end());
              return nodes;
            }
          for (int32_t n = 0; n < mesh.node_count(); ++n) nodes.push_back(NodeId(n));
        }
        return nodes;
      },
      load);
}

Loads::Loads(const Mesh& mesh, std::vector<LoadKind> kinds)
    : kinds_(std::move(kinds)), f_(size_t(mesh.node_count())), is_loaded_(f_.size(), 0) {
  for (auto& kind : kinds_) {
    std::visit([&](auto& load) { load.select(mesh); }, kind);
    follow(nodes_of_load(mesh, kind));
  }
}

void Loads::follow(const std::vector<NodeId>& nodes) {
  const size_t before = nodes_.size();
  for (const NodeId n : nodes)
    if (!is_loaded_[n]) is_loaded_[n] = 1, nodes_.push_back(n);
  if (nodes_.size() > before) std::sort(nodes_.begin(), nodes_.end());
  acting_ = nodes_;
}

bool Loads::are_on_faces() const {
  return std::all_of(kinds_.begin(), kinds_.end(), [](const LoadKind& kind) {
    return std::visit(
        [](const auto& load) {
          return requires { load.faces; };
        },
        kind);
  });
}

std::vector<LeftFace> Loads::leave(const Mesh& mesh, const std::vector<char>& is_left) {
  acting_.clear();
  for (const NodeId n : nodes_)
    if (size_t(n) >= is_left.size() || !is_left[size_t(n)]) acting_.push_back(n);
  std::vector<LeftFace> left;
  for (size_t k = 0; k < kinds_.size(); ++k)
    std::visit(
        [&](auto& load) {
          if constexpr (requires { load.faces; })
            for (const int32_t i : load.set().leave(mesh, is_left))
              left.push_back({int32_t(k), i, mesh.nodes_of(load.set()[size_t(i)])});
        },
        kinds_[k]);
  return left;
}

void Loads::add(const Mesh& mesh, double t, State& s, int64_t alone) {
  t_ = t;
  if (!is_spread_) spread_given(mesh);
  const auto for_acting = [&](const auto& work) {
    parallel_for(
        int64_t(acting_.size()), [&](int64_t i) { work(acting_[size_t(i)]); }, alone);
  };
  for_acting([&](NodeId n) { f_[n] = {}; });
  for (const auto& kind : kinds_) std::visit([&](const auto& load) { load.add(mesh, s.x, s.m, t, f_); }, kind);
  if (given_f_.size() > 0) for_acting([&](NodeId n) { f_[n] += given_f_[n]; });
  if (radiation) radiation->add(mesh, s, f_, alone);
  for_acting([&](NodeId n) {
    if (s.local.is_due(n)) s.f[n] += f_[n];
  });
}

double Loads::power(const State& s) const {
  return parallel_sum(int64_t(acting_.size()), [&](int64_t i) {
    const NodeId n = acting_[size_t(i)];
    return s.local.is_due(n) ? s.local.steps_of(n) * dot(f_[n], s.v[n]) : 0.0;
  });
}

void Loads::spread_given(const Mesh& mesh) {
  given_f_.resize(f_.size());
  for (const NodeId n : nodes_) given_f_[n] = {};
  for (size_t i = 0; i < given_.size(); ++i)
    for (NodeId n : mesh.nodes_of(given_faces_[i])) given_f_[n] += 0.25 * given_[i];
  is_spread_ = true;
}

void Loads::replace_given(const Mesh& mesh, std::span<const Face> faces, std::vector<Vec3> forces, State& s) {
  BW_CHECK(forces.size() == faces.size());
  const auto take_off = [&](int64_t i) { s.f[nodes_[size_t(i)]] -= f_[nodes_[size_t(i)]]; };
  parallel_for(int64_t(nodes_.size()), take_off, worth_waking);
  given_ = std::move(forces);
  std::vector<NodeId> nodes;
  if (!std::equal(given_faces_.begin(), given_faces_.end(), faces.begin(), faces.end())) {
    given_faces_.assign(faces.begin(), faces.end());
    for (const Face face : faces)
      for (const NodeId n : mesh.nodes_of(face))
        if (!is_loaded_[n]) nodes.push_back(n);
  }
  follow(nodes);
  is_spread_ = false;
  add(mesh, s.t, s, worth_waking);
}

void Loads::append_copies(std::span<const NodeSplit> splits) {
  for (const NodeSplit& split : splits) {
    f_.push_back(f_[split.parent]), is_loaded_.push_back(is_loaded_[split.parent]);
    if (is_loaded_[split.child]) nodes_.push_back(split.child), acting_.push_back(split.child);
  }
  is_spread_ = is_spread_ && given_f_.size() == 0;
}

}  // namespace bw::csd
