// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/contact.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numeric>
#include <span>

#include "common/parallel/loop.h"
#include "csd/fragments/foot.h"
#include "csd/fragments/meeting.h"
#include "csd/model.h"

namespace bw::csd {
namespace {

constexpr double along_edge = 0.02;  // of a face's size: so near to an edge it may have come through either face
constexpr int groups_per_chunk = 256;

/// Takes a direction from what a projection leaves.
void hold(Mat3& free, const Vec3& direction) {
  const Vec3 left = free * direction;
  const double size = dot(direction, left);
  if (size < 1e-9) return;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) free(i, j) -= left[i] * left[j] / size;
}

/// Directions in which a condition holds its nodes.
template <class C>
std::vector<Vec3> held_directions(const C& c) {
  if constexpr (std::same_as<C, Fixed>) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if constexpr (std::derived_from<C, OnPlane>) return {c.normal};
  std::vector<Vec3> directions;
  if constexpr (requires { c.components; })
    for (int d = 0; d < 3; ++d)
      if (c.components.find("xyz"[d]) != std::string::npos) directions.push_back({}), directions.back()[d] = 1;
  if constexpr (std::same_as<C, PrescribedDisplacement>) {
    if (c.across == "held") return held_directions(Fixed{});
    directions = {c.direction};
  }
  return directions;
}

/// A pair whose node may meet the face.
struct Near {
  const Contact::Pair* pair;
  Foot foot;
  double speed;  // m/s, of one relative to the other
};

/// Between a pair's node and face; nothing if they are of one rigid body, or of one that stands still.
std::optional<Meeting> meeting_of(Model& m, const Contact::Pair& pair, const Foot& foot) {
  const State& s = m.state;
  const auto quad = m.mesh.nodes_of(pair.face);
  Meeting p;
  p.nodes = {pair.node, quad[0], quad[1], quad[2], quad[3]};
  p.weight = {1, -foot.N[0], -foot.N[1], -foot.N[2], -foot.N[3]};
  p.normal = foot.normal, p.gap = foot.gap, p.size = foot.size;
  auto& rigid = m.physics.rigid;
  if (!rigid) return p;
  p.place = {rigid->body_at(pair.node), rigid->body_at(quad[0])};
  if (p.place[0] >= 0 && p.place[0] == p.place[1]) return std::nullopt;
  for (size_t k = 0; k < 2; ++k)
    if (p.place[k] >= 0) p.body[k] = &rigid->bodies()[size_t(p.place[k])];
  if ((p.body[0] && p.body[0]->is_stopped()) || (p.body[1] && p.body[1]->is_stopped())) return std::nullopt;
  p.first = p.body[0] ? 1 : 0, p.last = p.body[1] ? 1 : 5;
  // both are pushed at one point: that of the deformable one
  const Vec3 x = s.x[pair.node], point = p.body[0] && !p.body[1] ? x - foot.gap * foot.normal : x;
  for (size_t k = 0; k < 2; ++k)
    if (p.body[k]) p.arm[k] = point - p.body[k]->centre();
  return p;
}

/// Feet of the nodes of up to Pack::size pairs; none on faces that have the node.
Feet<Pack> feet_of(const Model& m, std::span<const Contact::Pair> pairs) {
  std::array<int32_t, Pack::size> at[5];
  Pack is_other;
  for (int l = 0; l < Pack::size; ++l) {
    const auto& [node, face, depth] = pairs[std::min(size_t(l), pairs.size() - 1)];
    const auto quad = m.mesh.nodes_of(face);
    at[0][size_t(l)] = node;
    for (size_t a = 0; a < 4; ++a) at[a + 1][size_t(l)] = quad[a];
    is_other.set(l, std::find(quad.begin(), quad.end(), node) == quad.end());
  }
  Vec<Pack> x[5];
  for (size_t a = 0; a < 5; ++a) load_points(&m.state.x.data()->x, at[a].data(), x[a].x, x[a].y, x[a].z);
  Feet<Pack> feet = feet_on(x[0], std::array{x[1], x[2], x[3], x[4]});
  feet.found *= is_other;
  return feet;
}

/// What the nodes of the groups [first, last) are about to meet.
void look(Model& m, const Contact::Nearby& nearby, int first, int last, std::vector<Near>& found) {
  const std::span<const Contact::Pair> pairs(nearby.pairs);
  const size_t end = size_t(nearby.group[size_t(last)]);
  size_t group = size_t(first), of_group = found.size();
  double nearest = 1e300;
  const auto is_other_side = [&](const Near& n) { return n.foot.gap < -nearest - along_edge * n.foot.size; };
  for (size_t begin = size_t(nearby.group[group]); begin < end; begin += Pack::size) {
    const size_t count = std::min(size_t(Pack::size), end - begin);
    const Feet<Pack> feet = feet_of(m, pairs.subspan(begin, count));
    for (size_t i = begin; i < begin + count; ++i) {
      if (const int l = int(i - begin); feet.found[l] > 0 && !(feet.gap[l] < -pairs[i].depth)) {
        const Foot foot = feet.of(l);
        if (const auto meeting = meeting_of(m, pairs[i], foot)) {
          found.push_back({&pairs[i], foot, norm(meeting->velocity(m.state))});
          nearest = std::min(nearest, std::fabs(foot.gap));
        }
      }
      if (i + 1 < size_t(nearby.group[group + 1])) continue;
      found.erase(std::remove_if(found.begin() + std::ptrdiff_t(of_group), found.end(), is_other_side), found.end());
      ++group, of_group = found.size(), nearest = 1e300;
    }
  }
}

}  // namespace

void Contact::renew_supports(const Model& m) {
  held_.row.assign(size_t(m.mesh.node_count()), -1), held_.free.clear();
  for (const auto& condition : m.physics.conditions)
    std::visit(
        [&](const auto& c) {
          const std::vector<Vec3> directions = held_directions(c);
          if (directions.empty()) return;
          for (const NodeId n : c.reaction.nodes) {
            int32_t& row = held_.row[size_t(n)];
            if (row < 0) row = int32_t(held_.free.size()), held_.free.push_back(Mat3::identity());
            for (const Vec3& d : directions) hold(held_.free[size_t(row)], d);
          }
        },
        condition);
}

std::vector<Meeting> Contact::find_meetings(Model& m, double dt) const {
  const int lips = near_lips_.count(), bodies = near_bodies_.count();
  const int lip_chunks = (lips + groups_per_chunk - 1) / groups_per_chunk,
            body_chunks = (bodies + groups_per_chunk - 1) / groups_per_chunk;
  std::vector<std::vector<Near>> found(size_t(lip_chunks + body_chunks));
  parallel_for_dynamic(int64_t(found.size()), [&](int64_t c) {
    const bool is_of_lips = c < lip_chunks;
    const int first = (int(c) - (is_of_lips ? 0 : lip_chunks)) * groups_per_chunk;
    look(m, is_of_lips ? near_lips_ : near_bodies_, first,
         std::min(is_of_lips ? lips : bodies, first + groups_per_chunk), found[size_t(c)]);
  });
  double fastest = 0;
  for (const auto& part : found)
    for (const Near& n : part) fastest = std::max(fastest, n.speed);
  std::vector<Meeting> meetings;
  for (const auto& part : found)
    for (const Near& n : part)
      if (n.foot.gap <= 2 * dt * fastest)  // an impulse of others may send it here, too
        meetings.push_back(*meeting_of(m, *n.pair, n.foot));
  parallel_for(int64_t(meetings.size()),
               [&](int64_t i) { begin(meetings[size_t(i)], m.state, held_, dt, input_.restitution); });
  return meetings;
}

namespace {

/// Puts the meetings that touch common nodes or bodies (islands) together, in the order of their lowest one; returns
/// where each begins, and the end. root: work space, [nodes + bodies].
std::vector<int32_t> sort_by_island(std::vector<Meeting>& meetings, int32_t nodes, std::vector<int32_t>& root) {
  const auto touched = [&](const Meeting& p, const auto& visit) {
    for (int i = p.first; i < p.last; ++i) visit(int32_t(p.nodes[size_t(i)]));
    for (const int32_t place : p.place)
      if (place >= 0) visit(nodes + place);
  };
  const auto find = [&](int32_t i) {
    while (root[size_t(i)] != i) i = root[size_t(i)] = root[size_t(root[size_t(i)])];
    return i;
  };
  for (const Meeting& p : meetings) touched(p, [&](int32_t i) { root[size_t(i)] = i; });
  for (const Meeting& p : meetings) {
    int32_t low = -1;
    touched(p, [&](int32_t i) {
      const int32_t r = find(i);
      if (low >= 0 && r != low) root[size_t(std::max(r, low))] = std::min(r, low);
      low = low < 0 ? r : std::min(r, low);
    });
  }
  std::vector<std::pair<int32_t, int32_t>> order;  // (island, place)
  for (Meeting& p : meetings) {
    touched(p, [&](int32_t i) { p.island = find(i); });
    order.push_back({p.island, int32_t(order.size())});
  }
  std::sort(order.begin(), order.end());
  std::vector<Meeting> sorted;
  sorted.reserve(meetings.size());
  for (const auto& [island, place] : order) sorted.push_back(meetings[size_t(place)]);
  meetings.swap(sorted);
  std::vector<int32_t> start;
  for (size_t i = 0; i < meetings.size(); ++i)
    if (i == 0 || meetings[i].island != meetings[i - 1].island) start.push_back(int32_t(i));
  start.push_back(int32_t(meetings.size()));
  return start;
}

}  // namespace

void Contact::act(Model& m, double dt) {
  pushed_.clear();
  renew(m, dt);
  if (near_lips_.count() + near_bodies_.count() == 0) return;
  std::vector<Meeting> meetings = find_meetings(m, dt);
  const auto approaches = [](const Meeting& p) { return p.approaches(); };
  if (std::none_of(meetings.begin(), meetings.end(), approaches)) return;
  const int32_t nodes = m.mesh.node_count();
  root_.resize(size_t(nodes) + (m.physics.rigid ? m.physics.rigid->bodies().size() : 0));
  const std::vector<int32_t> start = sort_by_island(meetings, nodes, root_);
  std::vector<double> work(start.size() - 1, 0.0);
  parallel_for_dynamic(int64_t(work.size()), [&](int64_t k) {
    const std::span<Meeting> island(meetings.data() + start[size_t(k)], meetings.data() + start[size_t(k) + 1]);
    if (std::any_of(island.begin(), island.end(), approaches))
      work[size_t(k)] = solve(island, m.state, held_, input_.friction);
  });
  work_ += std::accumulate(work.begin(), work.end(), 0.0);
  for (const Meeting& p : meetings) {
    if (p.impulse == Vec3{}) continue;
    ++impulses_;
    pushed_.insert(pushed_.end(), p.nodes.begin() + p.first, p.nodes.begin() + p.last);
    for (RigidBody* body : p.body)
      if (body) body->move_nodes(m.state.v);
  }
  std::sort(pushed_.begin(), pushed_.end());
  pushed_.erase(std::unique(pushed_.begin(), pushed_.end()), pushed_.end());
}

/// Brings up to date what may meet what.
void Contact::renew(Model& m, double dt) {
  find_depths(m.mesh);
  const bool is_cut = m.topology.version() != version_;
  if (is_cut) {
    version_ = m.topology.version();
    renew_supports(m);
    add_lips(m);
    follow_surface(m);
  }
  if (input_.lips && (is_cut || m.state.step % 10 == 0)) search_lips(m);
  if (!input_.bodies) return;
  const double fastest = parallel_max(int64_t(surface_.size()), 0.0, [&](int64_t i) {
    const Vec3 v = m.state.v[surface_[size_t(i)]] - drift_;
    return dot(v, v);
  });
  used_ += 2 * std::sqrt(fastest) * dt;
  if (used_ < margin_ && (searched_ == version_ || m.state.step < next_search_)) return;
  search_bodies(m, 2 * std::sqrt(fastest) * dt);
  searched_ = version_, next_search_ = m.state.step + 10;
}

}  // namespace bw::csd
