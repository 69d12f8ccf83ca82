// SPDX-License-Identifier: Apache-2.0
#include "csd/coupled.h"

#include <algorithm>
#include <cmath>

#include "common/app/version.h"
#include "common/io/file.h"
#include "coupling/loads.h"
#include "csd/load/sets.h"
#include "csd/step.h"

namespace bw::csd {
namespace {

coupling::Hello hello_of(const Case& cs, const Model& m, const coupling::WetSurface& wet) {
  coupling::Hello h;
  h.program = "csd", h.version = version();
  h.t0 = m.state.t, h.t_end = cs.run.time.end;
  h.lower = {1e300, 1e300, 1e300}, h.upper = {-1e300, -1e300, -1e300};
  for (const Vec3& x : wet.x)
    for (int d = 0; d < 3; ++d) h.lower[d] = std::fmin(h.lower[d], x[d]), h.upper[d] = std::fmax(h.upper[d], x[d]);
  return h;
}

double element_mass(const Model& m, ElemId e) {
  const double density =
      std::visit([](const auto& material) { return material.density; }, m.physics.elements.materials[size_t(m.mesh.body[e])]);
  return density * m.state.V0[m.physics.elements.blocks.slot[e]];
}

}  // namespace

Coupled::Coupled(coupling::Channel& channel, const Case& cs, Model& m) : case_(cs) {
  const auto& boundary = m.topology.boundary();
  if (cs.solid.wet.faces.empty())
    faces_.assign(boundary.begin(), boundary.begin() + m.topology.original_boundary_count());
  else
    faces_ = face_sets(m.mesh, cs.solid.wet.faces, cs.solid.wet.place);
  if (!m.physics.loads) m.physics.loads.emplace(m.mesh, std::vector<LoadKind>{});
  renew_surface(m);
  make_folder(cs.run.output.directory);
  side_ = std::make_unique<coupling::SolidSide>(channel, cs.coupling, hello_of(cs, m, wet_),
                                                cs.run.output.directory + "/coupling_history.csv");
}

void Coupled::renew_surface(const Model& m) {
  std::vector<Face> faces = faces_;
  const auto& boundary = m.topology.boundary();
  faces.insert(faces.end(), boundary.begin() + m.topology.original_boundary_count(), boundary.end());
  wet_ = {};
  wet_.topo_version = m.topology.version();
  nodes_.clear();
  mass_.clear();
  std::vector<int32_t> index(size_t(m.mesh.node_count()), -1);
  for (Face f : faces) {
    std::array<int32_t, 4> quad;
    for (size_t a = 0; a < 4; ++a) {
      const NodeId n = m.mesh.nodes_of(f)[a];
      if (index[size_t(n)] < 0) {
        index[size_t(n)] = int32_t(nodes_.size());
        nodes_.push_back(n);
        const NodeId parent = m.mesh.parent[n];
        wet_.node_id.push_back(m.mesh.node_gid[n]);
        wet_.node_parent.push_back(parent.valid() ? m.mesh.node_gid[parent] : -1);
      }
      quad[a] = index[size_t(n)];
    }
    wet_.quads.push_back(quad);
    mass_.push_back(element_mass(m, f.elem));
    wet_.face_id.push_back(m.mesh.elem_gid[f.elem] * 6 + f.side);
    wet_.body.push_back(m.mesh.body[f.elem]);
    wet_.flags.push_back(m.topology.is_lip(f) ? coupling::face_lip : 0);
  }
  update_surface(m);
}

std::vector<Vec3> Coupled::positions(const Model& m) const {
  std::vector<Vec3> x;
  for (NodeId n : nodes_) x.push_back(m.state.x[n]);
  return x;
}

void Coupled::update_surface(const Model& m) {
  wet_.x = positions(m);
  wet_.v.clear();
  for (NodeId n : nodes_) wet_.v.push_back(m.state.v[n]);
  areal_mass_.resize(mass_.size());
  for (size_t f = 0; f < mass_.size(); ++f) areal_mass_[f] = mass_[f] / norm(coupling::area_vector(wet_.x, wet_.quads[f]));
}

double Coupled::exchange(Model& m, double dt_stable, double t_max, bool last) {
  if (wet_.topo_version != m.topology.version())
    renew_surface(m);
  else
    update_surface(m);
  side_->send({.t0 = m.state.t, .t1_max = t_max, .dt_stable = dt_stable, .last = last}, wet_, areal_mass_);
  const coupling::Loads& loads = side_->receive();
  force_ = coupling::nodal_loads(wet_, loads, case_.coupling.reference_pressure);
  std::vector<std::pair<NodeId, Vec3>> forces;
  for (size_t i = 0; i < nodes_.size(); ++i) forces.emplace_back(nodes_[i], force_[i]);
  change_given_forces(m, std::move(forces));
  return loads.t1;
}

void Coupled::before_step(const Model& m) { x_before_ = positions(m); }

void Coupled::after_step(const Model& m, double dt) {
  side_->add(coupling::substep_totals(force_, wet_.x, x_before_, positions(m), dt));
}

void Coupled::end_window(const Model& m) { side_->end_window(positions(m)); }

}  // namespace bw::csd
