// SPDX-License-Identifier: Apache-2.0
// From deformable to rigid and back.
#include <algorithm>
#include <cmath>

#include "csd/element/results.h"
#include "csd/fragments/rigid.h"
#include "csd/model.h"

namespace bw::csd {
namespace {

/// What value gives for the elements that are asked for, on all ranks.
template <class T, class Value>
std::vector<T> of_elements(const Elements& el, const std::vector<char>& is_asked, const Value& value) {
  if (el.ranks) return el.ranks->complete_some<T>(is_asked, value);
  std::vector<T> values(is_asked.size());
  parallel_for(int64_t(is_asked.size()), [&](int64_t e) {
    if (is_asked[size_t(e)]) values[size_t(e)] = value(ElemId(e));
  });
  return values;
}

std::vector<NodeId> nodes_of(const Mesh& mesh, const std::vector<ElemId>& elems) {
  std::vector<NodeId> nodes;
  for (const ElemId e : elems) nodes.insert(nodes.end(), mesh.hex[e].begin(), mesh.hex[e].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Their kinetic energy [J], and what the product form has less (csd/energy.h).
struct Kinetic {
  double energy = 0, less = 0;
};
Kinetic kinetic(const State& s, const std::vector<NodeId>& nodes) {
  Kinetic k;
  for (const NodeId n : nodes) {
    k.energy += 0.5 * s.m[n] * dot(s.v[n], s.v[n]);
    const double dt = s.short_dt * s.local.steps_of(n);
    k.less += 0.125 * dt * dt / s.m[n] * dot(s.f[n], s.f[n]);
  }
  return k;
}
/// A switch: the inner motion is lost, and the product form jumps as at a change of the step.
void book(EnergyBooks& books, const Kinetic& before, const Kinetic& after) {
  books.rigidization += before.energy - after.energy;
  books.initial += before.less - after.less;
}

}  // namespace

std::vector<char> held_nodes(const Physics& ph, const Mesh& mesh) {
  std::vector<char> is_held(size_t(mesh.node_count()), 0);
  for (const auto& condition : ph.conditions)
    std::visit(
        [&]<class C>(const C& c) {
          if constexpr (!std::same_as<C, RigidWall> && !std::same_as<C, Spring> && !std::same_as<C, Damping>)
            for (const NodeId n : c.reaction.nodes) is_held[size_t(n)] = 1;
        },
        condition);
  return is_held;
}

const Fragments& Rigid::fragments(Model& m) {
  if (m.physics.cracks) return m.physics.cracks->fragments(m);
  if (!own_fragments_) own_fragments_.emplace(m.mesh, m.state.t);
  return *own_fragments_;
}

std::vector<Rigid::Piece> Rigid::pieces_of(Model& m, const std::vector<char>& is_label_wanted) {
  std::vector<Piece> pieces;
  std::vector<int32_t> place(is_label_wanted.size(), -1);
  for (size_t label = 0; label < is_label_wanted.size(); ++label)
    if (is_label_wanted[label]) place[label] = int32_t(pieces.size()), pieces.push_back({int32_t(label), {}});
  const auto& labels = fragments(m).label();
  for (int64_t e = 0; e < int64_t(labels.size()); ++e)
    if (const int32_t p = place[size_t(labels[ElemId(e)])]; p >= 0) pieces[size_t(p)].elems.push_back(ElemId(e));
  return pieces;
}

std::vector<Rigid::Piece> Rigid::switched_pieces(Model& m) {
  const Fragments& f = fragments(m);
  std::vector<char> is_wanted(size_t(f.count()), 0);
  for (int64_t e = 0; e < int64_t(f.label().size()); ++e)
    if (is_switched_[size_t(m.mesh.body[ElemId(e)])] && !is_rigid(m.mesh.hex[ElemId(e)][0]))
      is_wanted[size_t(f.label()[ElemId(e)])] = 1;
  return pieces_of(m, is_wanted);
}

/// Fragments that are small and old enough, and free.
std::vector<Rigid::Piece> Rigid::candidates(Model& m) {
  const int64_t opened = m.physics.cracks ? m.physics.cracks->opened_faces() : 0;
  if (input_.elements == 0 || m.state.step % input_.every != 0 || (opened == opened_ && !is_waiting_)) return {};
  opened_ = opened, is_waiting_ = false;
  const Fragments& f = fragments(m);
  std::vector<int64_t> count(size_t(f.count()), 0);
  std::vector<char> is_wanted(count.size(), 1);
  const auto held = held_nodes(m.physics, m.mesh);
  for (int64_t e = 0; e < int64_t(f.label().size()); ++e) {
    const size_t label = size_t(f.label()[ElemId(e)]);
    if (++count[label] > input_.elements || is_rigid(m.mesh.hex[ElemId(e)][0])) is_wanted[label] = 0;
    if (is_wanted[label])
      for (const NodeId n : m.mesh.hex[ElemId(e)])
        if (held[size_t(n)]) is_wanted[label] = 0;
  }
  for (size_t label = 0; label < count.size(); ++label) {
    if (label < whole_.size() && count[label] == whole_[label]) is_wanted[label] = 0;
    if (is_wanted[label] && m.state.t - f.birth(int(label)) < input_.age) is_wanted[label] = 0, is_waiting_ = true;
  }
  return pieces_of(m, is_wanted);
}

/// Leaves those that bear little stress.
void Rigid::keep_calm(Model& m, std::vector<Piece>& pieces) {
  if (input_.stress == 0 || pieces.empty()) return;
  struct Load {
    double stress, volume;
  };
  std::vector<char> is_asked(size_t(m.mesh.elem_count()), 0);
  for (const Piece& piece : pieces)
    for (const ElemId e : piece.elems) is_asked[size_t(e)] = 1;
  const Elements& el = m.physics.elements;
  const auto loads = of_elements<Load>(el, is_asked, [&](ElemId e) {
    const SlotId slot = el.blocks.slot[e];
    return Load{m.state.volume[slot] * von_mises(evaluate(el, m.state, slot).sigma), m.state.volume[slot]};
  });
  const auto is_strained = [&](const Piece& piece) {
    double sum = 0, volume = 0;
    for (const ElemId e : piece.elems) sum += loads[size_t(e)].stress, volume += loads[size_t(e)].volume;
    return sum >= input_.stress * volume;
  };
  is_waiting_ |= std::erase_if(pieces, is_strained) > 0;
}

void Rigid::freeze(Model& m, const std::vector<Piece>& pieces) {
  State& s = m.state;
  if (m.physics.elements.ranks) m.physics.elements.ranks->complete(s);
  for (const Piece& piece : pieces) {
    RigidBody body(nodes_of(m.mesh, piece.elems), s.x, s.v, s.m, motion_);
    const Kinetic before = kinetic(s, body.nodes());
    body.move_nodes(s.v);
    bodies_.push_back(std::move(body));
    elems_.push_back(piece.elems);
    if (input_.drag) air_.push_back(air_of(m, piece, bodies_.back())), add_drag(bodies_.size() - 1, s, 0);
    bodies_.back().take_forces(s.f);
    bodies_.back().share_forces(s.m, s.f);
    book(m.physics.energy, before, kinetic(s, bodies_.back().nodes()));
  }
}

/// A quarter of its surface is the mean presented area, exactly so for convex bodies [Cauchy].
Rigid::Air Rigid::air_of(const Model& m, const Piece& piece, const RigidBody& body) const {
  const DragInput& drag = *input_.drag;
  if (drag.size > 0 && 2 * body.radius() > drag.size) return {};
  if (drag.shape_factor > 0) return {drag.shape_factor * std::cbrt(body.mass() * body.mass()), {}};
  double surface = 0;
  for (const ElemId e : piece.elems)
    for (int side = 0; side < 6; ++side)
      if (!m.topology.is_bonded({e, side})) {
        const auto quad = m.mesh.nodes_of({e, side});
        surface += 0.5 * norm(cross(m.state.x[quad[2]] - m.state.x[quad[0]], m.state.x[quad[3]] - m.state.x[quad[1]]));
      }
  return {0.25 * surface, {}};
}

/// Bodies named in the case become deformable: their nodes get back the forces of their elements.
void Rigid::release(Model& m) {
  State& s = m.state;
  Elements& el = m.physics.elements;
  csd::complete(m);
  if (m.physics.loads) complete(*m.physics.loads);
  std::vector<char> is_asked(size_t(m.mesh.elem_count()), 0), is_freed(size_t(m.mesh.node_count()), 0);
  size_t kept = 0;
  std::vector<std::vector<NodeId>> freed;
  std::vector<Kinetic> before;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    if (!is_switched_[size_t(m.mesh.body[elems_[b].front()])] || bodies_[b].is_stopped()) {
      if (kept != b) bodies_[kept] = std::move(bodies_[b]), elems_[kept] = std::move(elems_[b]);
      if (input_.drag) air_[kept] = air_[b];
      ++kept;
      continue;
    }
    for (const ElemId e : elems_[b]) is_asked[size_t(e)] = 1;
    freed.push_back(bodies_[b].nodes());
    before.push_back(kinetic(s, freed.back()));
    s.local.set_level(freed.back(), 0);
    for (const NodeId n : freed.back())
      is_freed[size_t(n)] = 1, s.f[n] = m.physics.loads ? m.physics.loads->forces()[n] : Vec3{};
  }
  bodies_.erase(bodies_.begin() + std::ptrdiff_t(kept), bodies_.end()), elems_.resize(kept);
  if (input_.drag) air_.resize(kept);
  for (const auto& condition : m.physics.conditions)
    std::visit(
        [&](const auto& c) {
          for (size_t i = 0; i < c.reaction.nodes.size(); ++i)
            if (is_freed[size_t(c.reaction.nodes[i])]) s.f[c.reaction.nodes[i]] += c.reaction.R[i];
        },
        condition);
  const auto forces =
      of_elements<Corners<double>>(el, is_asked, [&](ElemId e) { return element_force(el, s, el.blocks.slot[e]); });
  for (size_t e = 0; e < is_asked.size(); ++e)
    if (is_asked[e])
      for (size_t a = 0; a < 8; ++a) s.f[m.mesh.hex[ElemId(int64_t(e))][a]] += forces[e].a[a];
  for (size_t b = 0; b < freed.size(); ++b) book(m.physics.energy, before[b], kinetic(s, freed[b]));
  m.physics.time_step.renew();
}

void Rigid::renew(Model& m) {
  for (; next_switch_ < input_.switch_times.size() && m.state.t >= input_.switch_times[next_switch_] * (1 - 1e-12);
       ++next_switch_) {
    if (next_switch_ % 2 == 0)
      release(m);
    else
      freeze(m, switched_pieces(m));
    renew_marks(m);
  }
  std::vector<Piece> pieces = candidates(m);
  keep_calm(m, pieces);
  if (!pieces.empty()) {
    const size_t before = bodies_.size();
    freeze(m, pieces);
    renew_marks(m, before);
  }
  if (input_.box && m.state.step % input_.every == 0) retire(m);
}

}  // namespace bw::csd
