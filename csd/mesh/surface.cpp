// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/surface.h"

#include <algorithm>

#include "common/app/error.h"
#include "common/parallel/loop.h"

namespace bw::csd {

Surface::Surface(const Mesh& mesh, const Topology& topology, const std::vector<std::string>& sets,
                 const std::string& place) {
  for (const std::string& name : sets) {
    const auto set = mesh.face_sets.find(name);
    if (set == mesh.face_sets.end() || set->second.empty()) {
      std::string known;
      for (const auto& [other, faces] : mesh.face_sets) known += faces.empty() ? "" : " " + other;
      throw InputError(place + ": no face set '" + name + "'; there are:" + known);
    }
    faces_.insert(faces_.end(), set->second.begin(), set->second.end());
  }
  if (sets.empty())
    faces_.assign(topology.boundary().begin(), topology.boundary().begin() + topology.original_boundary_count());
  std::sort(faces_.begin(), faces_.end(), [](Face a, Face b) { return face_code(a) < face_code(b); });
  faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
  original_ = faces_.size();
  lips_seen_ = size_t(topology.original_boundary_count());
}

bool Surface::update(const Mesh& mesh, const Topology& topology, const Field<Vec3, NodeId>& x,
                     const Field<Vec3, NodeId>& v) {
  const bool is_new = version_ != topology.version();
  if (is_new) {
    renew(mesh, topology);
    version_ = topology.version();
    ++wet_.topo_version;
  }
  const auto take_node = [&](int64_t i) {
    wet_.x[size_t(i)] = x[nodes_[size_t(i)]];
    wet_.v[size_t(i)] = v[nodes_[size_t(i)]];
  };
  parallel_for(int64_t(nodes_.size()), take_node, worth_waking);
  return is_new;
}

void Surface::renew(const Mesh& mesh, const Topology& topology) {
  const auto& boundary = topology.boundary();
  faces_.insert(faces_.end(), boundary.begin() + long(lips_seen_), boundary.end());
  lips_seen_ = boundary.size();
  number_.assign(size_t(mesh.node_count()), -1);
  for (const Face f : faces_)
    for (const NodeId n : mesh.nodes_of(f)) number_[size_t(n.value)] = 0;
  nodes_.clear();
  for (size_t n = 0; n < number_.size(); ++n)
    if (number_[n] == 0) {
      number_[n] = int32_t(nodes_.size());
      nodes_.push_back(NodeId(int64_t(n)));
    }
  const size_t faces = faces_.size(), nodes = nodes_.size();
  wet_.quads.resize(faces);
  wet_.face_id.resize(faces);
  wet_.body.resize(faces);
  wet_.flags.resize(faces);
  for (size_t i = 0; i < faces; ++i) {
    const Face f = faces_[i];
    const auto q = mesh.nodes_of(f);
    for (size_t k = 0; k < 4; ++k) wet_.quads[i][k] = number_[size_t(q[k].value)];
    wet_.face_id[i] = mesh.elem_gid[f.elem] * 6 + f.side;
    wet_.body[i] = mesh.body[f.elem];
    wet_.flags[i] = i < original_ ? 0 : coupling::face_lip;
  }
  wet_.x.resize(nodes);
  wet_.v.resize(nodes);
  wet_.node_id.resize(nodes);
  wet_.node_parent.resize(nodes);
  for (size_t i = 0; i < nodes; ++i) {
    const NodeId parent = mesh.parent[nodes_[i]];
    wet_.node_id[i] = mesh.node_gid[nodes_[i]];
    wet_.node_parent[i] = parent.valid() ? mesh.node_gid[parent] : -1;
  }
}

void Surface::add_forces(std::span<const Vec3> wet_force, Field<Vec3, NodeId>& f) const {
  BW_CHECK(wet_force.size() == nodes_.size());
  parallel_for(int64_t(nodes_.size()), [&](int64_t i) { f[nodes_[size_t(i)]] += wet_force[size_t(i)]; });
}

}  // namespace bw::csd
