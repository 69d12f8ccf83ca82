// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/rigid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/app/error.h"
#include "common/parallel/loop.h"
#include "csd/element/results.h"
#include "csd/fragments/impact.h"
#include "csd/model.h"

namespace bw::csd {

Rigid::Rigid(const RigidInput& input, const std::vector<std::string>& body_names, const Mesh& mesh)
    : input_(input),
      motion_(input.motion == "six_dof" ? RigidBody::Motion::six_dof : RigidBody::Motion::translation),
      is_switched_(body_names.size(), 0),
      is_rigid_(size_t(mesh.node_count()), 0) {
  for (int32_t n = 0; n < mesh.node_count(); ++n) free_.push_back(NodeId(n));
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

int64_t Rigid::free_count(const State& s) const {
  return int64_t(free_.size() + s.x.size() - is_rigid_.size());
}

void Rigid::complete(State& s) {
  if (is_current_) return;
  is_current_ = true;
  parallel_for(int64_t(bodies_.size()), [&](int64_t i) {
    const RigidBody& body = bodies_[size_t(i)];
    if (body.is_stopped()) return;
    body.place_nodes(s.x);
    body.move_nodes(s.v);
    body.share_forces(s.m, s.f);
  });
}

void Rigid::follow_all(Model& m) {
  complete(m.state);
  follows_all_ = true;
  go_on(m);
}

template <class Work>
void Rigid::for_bodies(const Work& work) {
  parallel_for(int64_t(bodies_.size()), [&](int64_t i) { work(bodies_[size_t(i)]); });
}

void Rigid::begin_kick(State& s, double h) {
  if (!asks_all_) return followers_.kick(bodies_, h);
  for_bodies([&](RigidBody& body) {
    if (body.is_stopped()) return;
    body.kick(h);
    body.move_nodes(s.v);
  });
}

/// Of followers nothing asks for velocities.
void Rigid::end_kick(State& s, double h) { begin_kick(s, h); }

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
  for_bodies([&](RigidBody& body) {
    if (body.is_stopped()) return;
    const bool turns = body.drift(dt);
    if (!asks_all_) return;
    body.place_nodes(s.x);
    if (turns) body.move_nodes(s.v);
  });
  if (!asks_all_) followers_.place(bodies_, s.x);
  is_current_ = false;
}

void Rigid::after_elements(const Elements& el, State& s) {
  if (s.local.all_due()) {
    if (asks_all_)
      for_bodies([&](const RigidBody& body) {
        for (const NodeId n : body.nodes()) s.f[n] = {};
      });
    else
      followers_.clear(s.f);
  }
  parallel_for(
      int64_t(kept_.size()),
      [&](int64_t k) {
        const Kept& kept = kept_[size_t(k)];
        if (!s.local.is_block_due(kept.block)) return;
        const int body = el.body_of(SlotId(kept.block * lanes));
        s.history[size_t(body)].change(el.blocks.row_of(body, kept.block), [&](double* history) {
          const double* value = kept.values.data();
          for (; value != kept.values.data() + kept.values.size(); history += lanes)
            for (const int l : kept.in_lanes) history[l] = *value++;
        });
      },
      64);
}

void Rigid::take_forces(const Loads* loads, State& s, double dt) {
  if (!asks_all_) return followers_.take_forces(bodies_, loads);
  drag_work_ += parallel_sum(int64_t(air_.size()), [&](int64_t b) { return add_drag(size_t(b), s, dt); });
  for_bodies([&](RigidBody& body) {
    body.take_forces(s.f);
    body.share_forces(s.m, s.f);
  });
}

double Rigid::load_power(const State& s) const {
  return asks_all_ || !s.local.all_due() ? 0 : s.local.shortest() * followers_.power();
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

/// Which elements are rigid, for the loops over elements, and what they must not change; bodies before `first` are
/// marked already. A body stays marked until all are marked anew.
void Rigid::renew_marks(Model& m, size_t first) {
  Elements& el = m.physics.elements;
  State& s = m.state;
  if (first == 0) {
    s.rigid = Field<double, SlotId>(size_t(el.blocks.slot_count()));
    is_rigid_.clear(), body_at_.clear(), free_.clear();
    kept_.clear(), elements_ = 0;
  }
  for (size_t n = is_rigid_.size(); n < s.x.size(); ++n) free_.push_back(NodeId(int64_t(n)));
  s.of_rigid.resize(size_t(el.blocks.block_count()));
  is_rigid_.resize(size_t(m.mesh.node_count()), 0), body_at_.resize(is_rigid_.size(), -1);
  std::vector<char> is_changed(size_t(el.blocks.block_count()), first == 0);
  for (size_t b = first; b < bodies_.size(); ++b) {
    for (const NodeId n : bodies_[b].nodes()) body_at_[size_t(n)] = int32_t(b), is_rigid_[size_t(n)] = 1;
    elements_ += int64_t(elems_[b].size());
    for (const ElemId e : elems_[b]) s.rigid[el.blocks.slot[e]] = 1, is_changed[size_t(el.blocks.slot[e] / lanes)] = 1;
    s.local.set_level(bodies_[b].nodes(), s.local.top());
  }
  std::erase_if(free_, [&](NodeId n) { return is_rigid_[size_t(n)]; });
  std::erase_if(kept_, [&](const Kept& kept) { return is_changed[size_t(kept.block)]; });
  for (int block = 0; block < el.blocks.block_count(); ++block)
    if (is_changed[size_t(block)]) renew_block(m, block);
  s.local.list_due();
  if (el.ranks) el.ranks->follow_also(is_rigid_, s);
  for (auto& condition : m.physics.conditions)
    if (auto* wall = std::get_if<RigidWall>(&condition)) wall->leave(is_rigid_);
  renew_asked(m, first);
}

/// Marks the lanes of a block, and keeps what elements of rigid bodies remember if others make it work.
void Rigid::renew_block(Model& m, int block) {
  const Elements& el = m.physics.elements;
  State& s = m.state;
  const SlotId first(block * lanes);
  const int used = el.blocks.used[size_t(block)];
  int count = 0;
  for (int l = 0; l < lanes; ++l) {
    s.rigid[SlotId(first + l)] = s.rigid[el.blocks.slot[el.blocks.elem[SlotId(first + l)]]];
    if (l < used) count += s.rigid[SlotId(first + l)] > 0;
  }
  Resting& resting = m.physics.resting;
  const bool was_rigid = resting.any() && resting.state[size_t(block)] == Resting::rigid;
  resting.set_rigid(block, count == used, el.blocks.block_count());
  if (count == 0 || !el.blocks.is_own(block)) return;
  if (count == used) {
    if (!was_rigid) s.of_rigid[size_t(block)] = stored_energy(el, s, block);
    return;
  }
  const PointHistory& histories = s.history[size_t(el.body_of(first))];
  Aligned<double> buffer(histories.block_size());
  const double* history = histories.read(el.blocks.row_of(el.body_of(first), block), buffer.data());
  Kept kept{block, {}, {}};
  for (int l = 0; l < used; ++l)
    if (s.rigid[SlotId(first + l)] > 0) kept.in_lanes.push_back(l);
  for (size_t i = 0; i < buffer.size(); i += lanes)
    for (const int l : kept.in_lanes) kept.values.push_back(history[i + size_t(l)]);
  kept_.push_back(std::move(kept));
}

/// Which nodes follow their bodies in each step, and on one rank which nodes the loops over nodes pass over.
void Rigid::renew_asked(Model& m, size_t first) {
  Physics& ph = m.physics;
  State& s = m.state;
  asks_all_ = follows_all_ || input_.drag || !ph.conditions.empty() || ph.relaxation || ph.mass_scaling || ph.contact ||
              (ph.loads && !ph.loads->are_on_faces());
  std::vector<LeftFace> left;
  if (ph.loads) {
    if (first == 0) complete(*ph.loads), ph.loads->leave(m.mesh, {});
    if (!asks_all_) left = ph.loads->leave(m.mesh, is_rigid_);
  }
  std::vector<NodeId> beside;
  std::vector<char> is_beside(is_rigid_.size(), 0);
  const Blocks& blocks = ph.elements.blocks;
  for (int block = 0; block < blocks.block_count(); ++block) {
    if (ph.resting.any() && ph.resting.state[size_t(block)] == Resting::rigid) continue;
    for (int l = 0; l < blocks.used[size_t(block)]; ++l)
      if (s.rigid[SlotId(block * lanes + l)] > 0)
        for (int a = 0; a < 8; ++a) {
          const NodeId n(blocks.nodes_of(block)[a * lanes + l]);
          if (!is_beside[size_t(n)]) is_beside[size_t(n)] = 1, beside.push_back(n);
        }
  }
  if (asks_all_) {
    followers_ = {};
  } else {
    followers_.append(bodies_, first, ph.loads ? &*ph.loads : nullptr, std::move(left), body_at_);
    followers_.set_beside(bodies_, beside, body_at_);
  }
  if (ph.elements.ranks) return;
  if (bodies_.empty()) return s.followed.clear();
  if (first == 0 || s.followed.empty()) {
    s.followed.resize(is_rigid_.size());
    std::iota(s.followed.begin(), s.followed.end(), 0);
  }
  std::erase_if(s.followed, [&](int32_t n) { return is_rigid_[size_t(n)] && !is_beside[size_t(n)]; });
}

}  // namespace bw::csd
