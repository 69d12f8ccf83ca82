// SPDX-License-Identifier: Apache-2.0
// Bodies that meet, and what a test watches of them.
#pragma once
#include "solid_scene.h"

namespace bw::csd {

struct Sums {
  Vec3 p, L;
  double size = 0;
};
inline Sums sums(const State& s) {
  Sums a;
  for (int n = 0; n < int(s.x.size()); ++n) {
    const Vec3 p = s.m[NodeId(n)] * s.v[NodeId(n)];
    a.p += p, a.L += cross(s.x[NodeId(n)], p), a.size += norm(p);
  }
  return a;
}
/// What a run did to the sums and the energy, worst of the steps.
struct Watch {
  Sums start, now;
  double kinetic, length;
  double p = 0, L = 0, residual = 0, work = 0, rise = -1e300;  ///< relative; rise: of the work of contact in a step
  Watch(Model& m, double length) : start(sums(m.state)), now(start), kinetic(kinetic_energy(m.state)), length(length) {
    m.physics.energy.initial = 0;
    m.physics.energy.initial = energy_row(m.physics, m.state).residual;
  }
  EnergyRow see(const Model& m) {
    now = sums(m.state);
    const EnergyRow row = energy_row(m.physics, m.state);
    p = std::fmax(p, norm(now.p - start.p) / start.size);
    L = std::fmax(L, norm(now.L - start.L) / (length * start.size));
    residual = std::fmax(residual, std::fabs(row.residual) / kinetic);
    rise = std::fmax(rise, row.contact / kinetic - work);
    work = row.contact / kinetic;
    return row;
  }
};
inline void make_rigid(Model& m) {
  RigidInput rigid;
  rigid.bodies = {"all"};
  m.physics.rigid.emplace(rigid, std::vector<std::string>{"all"}, m.mesh);
  m.physics.rigid->start(m);
}
inline double fastest_spin(const Model& m) {
  double spin = 0;
  for (const RigidBody& body : m.physics.rigid->bodies()) spin = std::fmax(spin, norm(body.spin()));
  return spin;
}
/// Depth of a node, or also of points of edges, in another body [m]; all bodies are convex.
inline double deepest(const Model& m, bool edges = false) {
  const Fragments pieces(m.mesh, 0);
  std::vector<std::vector<Face>> faces(size_t(pieces.count()));
  for (const Face f : m.topology.boundary()) faces[size_t(pieces.label()[f.elem])].push_back(f);
  std::vector<Vec3> centre(faces.size());
  std::vector<double> radius(faces.size(), 0);
  for (size_t k = 0; k < faces.size(); ++k) {
    for (const Face f : faces[k])
      for (const NodeId n : m.mesh.nodes_of(f)) centre[k] += 0.25 / double(faces[k].size()) * m.state.x[n];
    for (const Face f : faces[k])
      for (const NodeId n : m.mesh.nodes_of(f)) radius[k] = std::fmax(radius[k], norm(m.state.x[n] - centre[k]));
  }
  double deep = 0;
  const auto& x = m.state.x;
  const auto look = [&](size_t own, const Vec3& point) {
    for (size_t k = 0; k < faces.size(); ++k) {
      if (k == own || norm(point - centre[k]) > radius[k]) continue;
      double behind = 1;
      for (size_t f = 0; f < faces[k].size() && behind > deep; ++f) {
        const auto q = m.mesh.nodes_of(faces[k][f]);
        behind = std::fmin(behind, -dot(point - x[q[0]], unit(cross(x[q[2]] - x[q[0]], x[q[3]] - x[q[1]]))));
      }
      deep = std::fmax(deep, behind);
    }
  };
  for (size_t k = 0; k < faces.size(); ++k)
    for (const Face f : faces[k]) {
      const auto q = m.mesh.nodes_of(f);
      for (size_t a = 0; a < 4; ++a)
        for (int i = 0; i < (edges ? 4 : 1); ++i) look(k, x[q[a]] + 0.25 * i * (x[q[(a + 1) % 4]] - x[q[a]]));
    }
  return deep;
}
inline Mesh together(std::vector<Mesh> parts) {
  std::vector<std::string> names;
  for (size_t i = 0; i < parts.size(); ++i) names.push_back("b" + std::to_string(i));
  Mesh mesh = merge(std::move(parts), names);
  for (int e = 0; e < mesh.elem_count(); ++e) mesh.body[ElemId(e)] = 0;
  return mesh;
}
inline void move(Mesh& mesh, const Mat3& R, const Vec3& by) {
  for (Vec3& X : mesh.X) X = R * X + by;
}

}  // namespace bw::csd
