// SPDX-License-Identifier: Apache-2.0
#include "csd/load/radiation.h"

#include <algorithm>
#include <utility>

#include "common/parallel/loop.h"

namespace bw::csd {

void Radiation::begin(const Mesh& mesh, const State& s, std::vector<RadiatingFace> faces, double largest) {
  impulse_.assign(faces.size(), {});
  work_ = 0;
  faces_.clear(), place_.clear();
  for (size_t i = 0; i < faces.size(); ++i)
    if (faces[i].impedance > 0) faces_.push_back(faces[i]), place_.push_back(i);
  force_.assign(faces_.size(), 0.0);
  std::vector<double> around(mesh.X.size(), 0.0);
  for (const RadiatingFace& f : faces_)
    for (const NodeId n : mesh.nodes_of(f.face)) around[size_t(n)] += 0.25 * f.impedance;
  const double h = s.dt_stable / s.local.shortest();
  for (RadiatingFace& f : faces_) {
    double share = 1;
    for (const NodeId n : mesh.nodes_of(f.face))
      share = std::min(share, largest * s.m[n] / (h * s.local.steps_of(n) * around[size_t(n)]));
    f.impedance *= share;
  }
}

void Radiation::add(const Mesh& mesh, const State& s, Field<Vec3, NodeId>& f) {
  parallel_for(int64_t(faces_.size()), [&](int64_t i) {
    const RadiatingFace& face = faces_[size_t(i)];
    Vec3 v;
    for (const NodeId n : mesh.nodes_of(face.face)) v += 0.25 * s.v[n];
    force_[size_t(i)] = -face.impedance * (dot(v, face.n) - face.told);
  });
  for (size_t i = 0; i < faces_.size(); ++i) {
    const Vec3 part = (0.25 * force_[i]) * faces_[i].n;
    for (const NodeId n : mesh.nodes_of(faces_[i].face)) f[n] += part;
  }
}

void Radiation::book(const Mesh& mesh, const State& s, double h) {
  for (size_t i = 0; i < faces_.size(); ++i) {
    const RadiatingFace& face = faces_[i];
    double time = 0, way = 0;  // of its nodes
    for (const NodeId n : mesh.nodes_of(face.face)) {
      if (!s.local.is_due(n)) continue;
      const double quarter = 0.25 * h * s.local.steps_of(n);
      time += quarter, way += quarter * dot(s.v[n], face.n);
    }
    impulse_[place_[i]] += (force_[i] * time) * face.n;
    work_ += force_[i] * way;
  }
}

}  // namespace bw::csd
