// SPDX-License-Identifier: Apache-2.0
#include "csd/load/radiation.h"

#include <algorithm>
#include <utility>

#include "common/parallel/loop.h"

namespace bw::csd {

void Radiation::begin(const Mesh& mesh, const State& s, RadiatingFaces faces, double largest) {
  impulse_.assign(faces.size(), {});
  work_ = 0, largest_ = largest;
  if (std::none_of(faces.impedance.begin(), faces.impedance.end(), [](double z) { return z > 0; })) faces = {};
  if (faces.face != faces_.face) mesh_nodes_ = 0;
  faces_ = std::move(faces);
  force_.assign(faces_.size(), 0.0), acting_.resize(faces_.size());
  fit(mesh);
  bound(s);
}

/// Nodes of the faces, if there are new ones.
void Radiation::fit(const Mesh& mesh) {
  if (mesh_nodes_ == mesh.X.size()) return;
  mesh_nodes_ = mesh.X.size(), dt_ = 0;
  nodes_.clear(), corner_.resize(faces_.size());
  std::vector<int32_t> place(mesh_nodes_, -1);
  for (size_t i = 0; i < faces_.size(); ++i) {
    const auto quad = mesh.nodes_of(faces_.face[i]);
    for (size_t k = 0; k < 4; ++k) {
      int32_t& at = place[size_t(quad[k])];
      if (at < 0) at = int32_t(nodes_.size()), nodes_.push_back(quad[k]);
      corner_[i][k] = at;
    }
  }
  around_ = Csr<int32_t>::build(int64_t(nodes_.size()), [&](auto&& add) {
    for (size_t i = 0; i < corner_.size(); ++i)
      for (const int32_t k : corner_[i]) add(k, int32_t(i));
  });
}

void Radiation::bound(const State& s) {
  dt_ = s.dt_stable;
  const double h = dt_ / s.local.shortest();
  std::vector<double> share(nodes_.size());
  const auto find_share = [&](int64_t k) {
    const NodeId n = nodes_[size_t(k)];
    double sum = 0;
    for (const int32_t i : around_[k]) sum += 0.25 * faces_.impedance[size_t(i)];
    share[size_t(k)] = sum > 0 ? largest_ * s.m[n] / (h * s.local.steps_of(n) * sum) : 1;
  };
  const auto find_acting = [&](int64_t i) {
    double least = 1;
    for (const int32_t k : corner_[size_t(i)]) least = std::min(least, share[size_t(k)]);
    acting_[size_t(i)] = least * faces_.impedance[size_t(i)];
  };
  parallel_for(int64_t(nodes_.size()), find_share, worth_waking);  // a window begins: threads have gone to sleep
  parallel_for(int64_t(faces_.size()), find_acting, worth_waking);
}

void Radiation::add(const Mesh& mesh, const State& s, Field<Vec3, NodeId>& f, int64_t alone) {
  if (faces_.size() == 0) return;
  fit(mesh);
  if (s.dt_stable > dt_) bound(s);
  const auto find_force = [&](int64_t i) {
    Vec3 v;
    for (const int32_t k : corner_[size_t(i)]) v += 0.25 * s.v[nodes_[size_t(k)]];
    force_[size_t(i)] = -acting_[size_t(i)] * (dot(v, faces_.n[size_t(i)]) - faces_.told[size_t(i)]);
  };
  const auto add_to_node = [&](int64_t k) {
    Vec3& sum = f[nodes_[size_t(k)]];
    for (const int32_t i : around_[k]) sum += (0.25 * force_[size_t(i)]) * faces_.n[size_t(i)];
  };
  parallel_for(int64_t(faces_.size()), find_force, alone);
  parallel_for(int64_t(nodes_.size()), add_to_node, alone);
}

void Radiation::book(const Mesh& mesh, const State& s, double h) {
  if (faces_.size() == 0) return;
  fit(mesh);
  work_ += parallel_sum(int64_t(faces_.size()), [&](int64_t i) {
    const Vec3& normal = faces_.n[size_t(i)];
    double time = 0, way = 0;  // of its nodes
    for (const int32_t k : corner_[size_t(i)]) {
      const NodeId n = nodes_[size_t(k)];
      if (!s.local.is_due(n)) continue;
      const double quarter = 0.25 * h * s.local.steps_of(n);
      time += quarter, way += quarter * dot(s.v[n], normal);
    }
    impulse_[size_t(i)] += (force_[size_t(i)] * time) * normal;
    return force_[size_t(i)] * way;
  });
}

}  // namespace bw::csd
