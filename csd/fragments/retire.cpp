// SPDX-License-Identifier: Apache-2.0
// Fragments that have left the box.
#include <algorithm>

#include "csd/fragments/rigid.h"
#include "csd/model.h"

namespace bw::csd {
namespace {

/// All its nodes lie beyond one side.
bool is_beyond(const RigidBody& body, const State& s, const BoxInput& box) {
  for (int d = 0; d < 3; ++d)
    for (const double sign : {-1.0, 1.0}) {
      const double side = sign > 0 ? box.upper[d] : -box.lower[d];
      if (sign * body.centre()[d] > side &&
          std::all_of(body.nodes().begin(), body.nodes().end(), [&](NodeId n) { return sign * s.x[n][d] > side; }))
        return true;
    }
  return false;
}

}  // namespace

/// Those that fly beyond it and aren't rigid yet.
std::vector<Rigid::Piece> Rigid::beyond_box(Model& m) {
  const Fragments& f = fragments(m);
  struct Extent {
    Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  };
  std::vector<Extent> extent(size_t(f.count()));
  std::vector<char> is_wanted(extent.size(), 1);
  const auto held = held_nodes(m.physics, m.mesh);
  for (int64_t i = 0; i < m.mesh.elem_count(); ++i) {
    const auto& hex = m.mesh.hex[ElemId(i)];
    const size_t label = size_t(f.label()[ElemId(i)]);
    if (is_rigid(hex[0])) is_wanted[label] = 0;
    if (!is_wanted[label]) continue;
    for (const NodeId n : hex) {
      if (held[size_t(n)]) is_wanted[label] = 0;
      for (int d = 0; d < 3; ++d) {
        extent[label].lower[d] = std::min(extent[label].lower[d], m.state.x[n][d]);
        extent[label].upper[d] = std::max(extent[label].upper[d], m.state.x[n][d]);
      }
    }
  }
  for (size_t label = 0; label < extent.size(); ++label) {
    bool is_inside = true;
    for (int d = 0; d < 3; ++d)
      is_inside =
          is_inside && extent[label].lower[d] <= input_.box->upper[d] && extent[label].upper[d] >= input_.box->lower[d];
    if (is_inside) is_wanted[label] = 0;
  }
  return pieces_of(m, is_wanted);
}

void Rigid::retire(Model& m) {
  State& s = m.state;
  csd::complete(m);
  const auto pieces = beyond_box(m);
  if (!pieces.empty()) {
    freeze(m, pieces);
    renew_marks(m);
  }
  for (size_t b = 0; b < bodies_.size(); ++b) {
    RigidBody& body = bodies_[b];
    if (body.is_stopped()) continue;
    if (!is_beyond(body, s, *input_.box)) continue;
    records_.push_back(
        {elems_[b].front(), s.t, body.velocity(), body.angular_momentum(), body.spin(), body.kinetic_energy()});
    ++left_.count, left_.mass += body.mass(), left_.momentum += body.mass() * body.velocity();
    for (const NodeId n : body.nodes()) {
      m.physics.energy.left += 0.5 * s.m[n] * dot(s.v[n], s.v[n]);
      const double dt = s.short_dt * s.local.steps_of(n);
      m.physics.energy.initial += 0.125 * dt * dt / s.m[n] * dot(s.f[n], s.f[n]);  // what the product form has less
      s.v[n] = s.f[n] = {};
    }
    body.stop();
  }
}

void Rigid::add_left(Model& m, std::vector<Fragment>& table) {
  const Fragments& f = fragments(m);
  for (const Record& record : records_) {
    Fragment& row = table[size_t(f.label()[record.elem])];
    row.left = record.t, row.velocity = record.velocity, row.spin = record.spin;
    row.angular_momentum = record.angular_momentum, row.kinetic_energy = record.kinetic_energy;
  }
}

}  // namespace bw::csd
