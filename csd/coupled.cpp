// SPDX-License-Identifier: Apache-2.0
#include "csd/coupled.h"

#include <algorithm>
#include <cmath>

#include "common/app/version.h"
#include "common/io/file.h"
#include "coupling/loads.h"
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

/// Mass behind each wet face, that of its element, per area [kg/m^2].
std::vector<double> areal_mass(const Model& m, const Surface& surface) {
  std::vector<double> result;
  result.reserve(surface.faces().size());
  for (size_t f = 0; f < surface.faces().size(); ++f) {
    const ElemId e = surface.faces()[f].elem;
    const double density = std::visit([](const auto& material) { return material.density; },
                                      m.physics.elements.materials[size_t(m.mesh.body[e])]);
    result.push_back(density * m.state.V0[m.physics.elements.blocks.slot[e]] /
                     norm(coupling::area_vector(surface.wet().x, surface.wet().quads[f])));
  }
  return result;
}

}  // namespace

Coupled::Coupled(coupling::Channel& channel, const Case& cs, Model& m)
    : case_(cs), surface_(m.mesh, m.topology, cs.solid.wet.faces, cs.solid.wet.place) {
  if (const auto& ranks = m.physics.elements.ranks) ranks->follow_all(m.state);
  if (!m.physics.loads) m.physics.loads.emplace(m.mesh, std::vector<LoadKind>{});
  surface_.update(m.mesh, m.topology, m.state.x, m.state.v);
  make_folder(cs.run.output.directory);
  side_ = std::make_unique<coupling::SolidSide>(channel, cs.coupling, hello_of(cs, m, surface_.wet()),
                                                cs.run.output.directory + "/coupling_history.csv");
}

std::vector<Vec3> Coupled::positions(const Model& m) const {
  std::vector<Vec3> x;
  x.reserve(nodes_.size());
  for (NodeId n : nodes_) x.push_back(m.state.x[n]);
  return x;
}

double Coupled::exchange(Model& m, double dt_stable, double t_max) {
  surface_.update(m.mesh, m.topology, m.state.x, m.state.v);
  nodes_ = surface_.nodes();
  side_->send({.t0 = m.state.t, .t1_max = t_max, .dt_stable = dt_stable}, surface_.wet(), areal_mass(m, surface_));
  const coupling::Loads& loads = side_->receive();
  const std::vector<Vec3> on_faces = coupling::face_forces(surface_.wet(), loads, case_.coupling.reference_pressure);
  force_ = coupling::nodal_loads(surface_.wet(), on_faces);
  std::vector<std::pair<Face, Vec3>> forces;
  for (size_t i = 0; i < on_faces.size(); ++i) forces.emplace_back(surface_.faces()[i], on_faces[i]);
  change_given_forces(m, std::move(forces));
  return loads.t1;
}

void Coupled::before_step(const Model& m) { x_before_ = positions(m); }

void Coupled::after_step(const Model& m, double dt) {
  side_->add(coupling::substep_totals(force_, surface_.wet().x, x_before_, positions(m), dt));
}

void Coupled::end_window(const Model& m) { side_->end_window(positions(m)); }

}  // namespace bw::csd
