// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/rigid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/app/error.h"
#include "common/parallel/loop.h"
#include "csd/fragments/impact.h"
#include "csd/model.h"

namespace bw::csd {
namespace {

/// change(values) with the histories of the block of a slot, those of the slot `lanes` apart; kept.
template <class Change>
void change_history(const Elements& el, State& s, SlotId slot, const Change& change) {
  const int body = el.body_of(slot);
  s.history[size_t(body)].change(el.blocks.row_of(body, slot / lanes),
                                 [&](double* values) { change(values + slot % lanes); });
}

}  // namespace

Rigid::Rigid(const RigidInput& input, const std::vector<std::string>& body_names, const Mesh& mesh)
    : input_(input),
      motion_(input.motion == "six_dof" ? RigidBody::Motion::six_dof : RigidBody::Motion::translation),
      is_switched_(body_names.size(), 0),
      is_rigid_(size_t(mesh.node_count()), 0) {
  for (const std::string& name : input.bodies) {
    const auto it = std::find(body_names.begin(), body_names.end(), name);
    if (it == body_names.end())
      throw InputError(
          fmt::format("{}: there is no body \"{}\"; there are: {}", input.place, name, fmt::join(body_names, ", ")));
    is_switched_[size_t(it - body_names.begin())] = 1;
  }
}

void Rigid::start(Model& m) {
  const Fragments& f = fragments(m);
  whole_.assign(size_t(f.count()), 0);
  for (const int32_t label : f.label()) ++whole_[size_t(label)];
  const auto pieces = switched_pieces(m);
  const auto held = held_nodes(m.physics, m.mesh);
  for (const Piece& piece : pieces)
    for (const ElemId e : piece.elems)
      for (const NodeId n : m.mesh.hex[e])
        if (held[size_t(n)]) throw InputError(fmt::format("{}: a condition holds nodes of a rigid body", input_.place));
  if (pieces.empty()) return;
  freeze(m, pieces);
  renew_marks(m);
}

void Rigid::go_on(Model& m) {
  if (m.state.rigid.size() > 0) renew_marks(m);
}

void Rigid::complete(State& s) {
  if (is_current_) return;
  is_current_ = true;
  parallel_for(int64_t(bodies_.size()), [&](int64_t i) {
    const RigidBody& body = bodies_[size_t(i)];
    if (body.is_stopped()) return;
    body.place_nodes(s.x);
    body.move_nodes(s.v);
    body.share_forces(s.m, s.f, RigidBody::Which::all);
  });
}

void Rigid::follow_all(Model& m) {
  complete(m.state);
  follows_all_ = true;
  go_on(m);
}

/// Bodies that forces may act on.
template <class Work>
void Rigid::for_pushed(const Work& work) {
  parallel_for(int64_t(pushed_.size()), [&](int64_t i) { work(bodies_[size_t(pushed_[size_t(i)])]); });
}

void Rigid::begin_kick(State& s, double h) {
  for_pushed([&](RigidBody& body) {
    if (body.is_stopped()) return;
    body.kick(h);
    body.move_nodes(s.v, RigidBody::Which::asked);
  });
}

/// Loads don't ask for velocities before the next one begins.
void Rigid::end_kick(State& s, double h) {
  for_pushed([&](RigidBody& body) {
    if (body.is_stopped()) return;
    body.kick(h);
    if (asks_all_) body.move_nodes(s.v);
  });
}

void Rigid::meet_walls(std::vector<ConditionKind>& conditions, State& s, double dt) {
  std::vector<RigidWall*> walls;
  for (auto& condition : conditions)
    if (auto* wall = std::get_if<RigidWall>(&condition)) walls.push_back(wall);
  if (walls.empty()) return;
  std::vector<Touch> touches;
  std::vector<RigidWall*> touched;
  for (RigidBody& body : bodies_) {
    if (body.is_stopped()) continue;
    touches.clear(), touched.clear();
    for (RigidWall* wall : walls) {
      const Vec3& n = wall->normal;
      const double reach = dt * (norm(body.velocity() - wall->moves()) + norm(body.spin()) * body.radius());
      if (dot(body.centre() - wall->point, n) > body.radius() + reach) continue;
      const double friction = wall->friction == "none" ? 0 : wall->friction == "stick" ? 1e300 : wall->coefficient;
      for (size_t i = 0; i < body.nodes().size(); ++i) {
        if (!wall->stops(body.nodes()[i])) continue;
        const double gap = dot(s.x[body.nodes()[i]] - wall->point, n);
        if (gap > 2 * reach) continue;
        touches.push_back({body.arm(i), n, wall->moves(), std::max(gap, 0.0) / dt, wall->restitution, friction});
        touched.push_back(wall);
      }
    }
    if (!resolve(body, touches)) continue;
    for (size_t i = 0; i < touches.size(); ++i) {
      const Touch& t = touches[i];
      touched[i]->reaction.impulse += t.impulse;
      touched[i]->reaction.work += 0.5 * dot(t.impulse, t.before + body.velocity_at(t.arm));
    }
    body.move_nodes(s.v);
  }
}

void Rigid::drift(State& s, double dt) {
  parallel_for(int64_t(bodies_.size()), [&](int64_t i) {
    RigidBody& body = bodies_[size_t(i)];
    if (body.is_stopped()) return;
    body.drift(dt);
    body.place_nodes(s.x, RigidBody::Which::asked);
    body.move_nodes(s.v, RigidBody::Which::asked);
  });
  is_current_ = false;
}

void Rigid::after_elements(const Elements& el, State& s) {
  if (s.local.all_due())
    for_pushed([&](const RigidBody& body) {
      body.for_places(RigidBody::Which::asked, [&](size_t i) { s.f[body.nodes()[i]] = {}; });
    });
  for (const Kept& kept : kept_) {
    if (!s.local.is_block_due(kept.slot / lanes)) continue;
    change_history(el, s, kept.slot, [&](double* history) {
      for (size_t i = 0; i < kept.values.size(); ++i) history[i * lanes] = kept.values[i];
    });
  }
}

void Rigid::take_forces(State& s, double dt) {
  drag_work_ += parallel_sum(int64_t(air_.size()), [&](int64_t b) { return add_drag(size_t(b), s, dt); });
  for_pushed([&](RigidBody& body) {
    body.take_forces(s.f, RigidBody::Which::asked);
    if (asks_all_ || body.is_stopped()) body.share_forces(s.m, s.f, RigidBody::Which::asked);
  });
  if (any_new_) std::erase_if(pushed_, [&](int32_t b) { return !bodies_[size_t(b)].is_asked(); });
  any_new_ = false;
}

double Rigid::add_drag(size_t b, State& s, double dt) {
  const RigidBody& body = bodies_[b];
  Air& air = air_[b];
  if (body.is_stopped() || air.area == 0) {
    air.R = {};
    return 0;
  }
  Vec3 others;
  for (const NodeId n : body.nodes()) others += s.f[n];
  const Vec3 before = air.R;
  air.R = input_.drag->force(air.area, body.mass(), body.velocity() + 0.5 * dt / body.mass() * others, 0.5 * dt);
  for (const NodeId n : body.nodes()) s.f[n] += s.m[n] / body.mass() * air.R;
  return 0.5 * dt * dot(before + air.R, body.velocity());
}

void Rigid::give_back(State& s) {
  for (size_t b = 0; b < air_.size(); ++b)
    for (const NodeId n : bodies_[b].nodes()) s.f[n] -= s.m[n] / bodies_[b].mass() * air_[b].R;
}

double Rigid::accurate_step() const {
  double step = 1e300;
  for (const RigidBody& body : bodies_) {
    if (body.is_stopped()) continue;
    constexpr double slow = 1;  // m/s: what rests may begin to move
    step = std::min({step, 0.1 * body.radius() / (slow + norm(body.velocity())), 0.05 / (norm(body.spin()) + 1e-6)});
  }
  return step;
}

/// Which elements are rigid, for the loops over elements; and what they must not change.
void Rigid::renew_marks(Model& m) {
  Elements& el = m.physics.elements;
  State& s = m.state;
  s.rigid = Field<double, SlotId>(size_t(el.blocks.slot_count()));
  is_rigid_.assign(size_t(m.mesh.node_count()), 0), body_at_.assign(is_rigid_.size(), -1);
  for (size_t b = 0; b < bodies_.size(); ++b)
    for (const NodeId n : bodies_[b].nodes()) body_at_[size_t(n)] = int32_t(b);
  elements_ = 0;
  for (const auto& elems : elems_) {
    elements_ += int64_t(elems.size());
    for (const ElemId e : elems) {
      s.rigid[el.blocks.slot[e]] = 1;
      for (const NodeId n : m.mesh.hex[e]) is_rigid_[size_t(n)] = 1;
    }
  }
  kept_.clear();
  for (int block = 0; block < el.blocks.block_count(); ++block) {
    const SlotId first(block * lanes);
    const int used = el.blocks.used[size_t(block)];
    int count = 0;
    for (int l = 0; l < lanes; ++l) {
      s.rigid[SlotId(first + l)] = s.rigid[el.blocks.slot[el.blocks.elem[SlotId(first + l)]]];
      if (l < used) count += s.rigid[SlotId(first + l)] > 0;
    }
    m.physics.resting.set_rigid(block, count == used, el.blocks.block_count());
    if (count == 0 || count == used || !el.blocks.is_own(block)) continue;
    const PointHistory& histories = s.history[size_t(el.body_of(first))];
    Aligned<double> buffer(histories.block_size());
    const double* history = histories.read(el.blocks.row_of(el.body_of(first), block), buffer.data());
    for (int l = 0; l < used; ++l) {
      const SlotId slot(first + l);
      if (s.rigid[slot] == 0) continue;
      Kept kept{slot, std::vector<double>(buffer.size() / lanes)};
      for (size_t i = 0; i < kept.values.size(); ++i) kept.values[i] = history[i * lanes + size_t(l)];
      kept_.push_back(std::move(kept));
    }
  }
  for (const RigidBody& body : bodies_) s.local.set_level(body.nodes(), s.local.top());
  s.local.list_due();
  if (el.ranks) el.ranks->follow_also(is_rigid_, s);
  for (auto& condition : m.physics.conditions)
    if (auto* wall = std::get_if<RigidWall>(&condition)) wall->leave(is_rigid_);
  renew_asked(m);
}

/// Which nodes follow their bodies in each step, and on one rank which the loops over nodes go over.
void Rigid::renew_asked(Model& m) {
  const Physics& ph = m.physics;
  State& s = m.state;
  const Blocks& blocks = ph.elements.blocks;
  asks_all_ = follows_all_ || input_.drag || !ph.conditions.empty() || ph.relaxation || ph.mass_scaling || ph.contact ||
              ph.elements.ranks;
  std::vector<char> is_asked(is_rigid_.size(), asks_all_);
  std::vector<char> is_free(is_rigid_.size());
  parallel_for(int64_t(is_free.size()), [&](int64_t n) { is_free[size_t(n)] = !is_rigid_[size_t(n)]; });
  for (int block = 0; block < blocks.block_count(); ++block)
    if (!ph.resting.any() || ph.resting.state[size_t(block)] != Resting::rigid)
      for (int i = 0; i < 8 * lanes; ++i) {
        const size_t n = size_t(blocks.nodes_of(block)[i]);
        is_asked[n] = is_free[n] = 1;
      }
  if (ph.loads)
    for (const NodeId n : ph.loads->nodes()) is_asked[size_t(n)] = 1;
  parallel_for(int64_t(bodies_.size()), [&](int64_t i) { bodies_[size_t(i)].ask(is_asked); });
  pushed_.resize(bodies_.size());
  std::iota(pushed_.begin(), pushed_.end(), 0);
  any_new_ = true;
  if (ph.elements.ranks) return;
  s.followed.clear();
  if (bodies_.empty()) return;
  for (size_t n = 0; n < is_free.size(); ++n)
    if (is_free[n]) s.followed.push_back(int32_t(n));
}

}  // namespace bw::csd
