// SPDX-License-Identifier: Apache-2.0
#include "csd/probe.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/error.h"
#include "common/app/log.h"
#include "csd/element/lanes.h"
#include "csd/element/results.h"
#include "csd/mesh/hex.h"
#include "csd/physics.h"

namespace bw::csd {

namespace {

/// A place in the wrong unit finds a node too: says so where it lies further off than elements are long.
void warn_if_far(const Mesh& mesh, const char* what, const Vec3& position, double distance, ElemId nearest) {
  double longest = 0;
  for (const auto& edge : hex_edge) {
    const auto& h = mesh.hex[nearest];
    longest = std::max(longest, norm(mesh.X[h[size_t(edge[1])]] - mesh.X[h[size_t(edge[0])]]));
  }
  if (distance > longest)
    warn("a probe at ({:.6g}, {:.6g}, {:.6g}) m: the nearest {} is {:.3g} m away", position.x, position.y, position.z,
         what, distance);
}

}  // namespace

void NodeProbe::select(const Mesh& mesh, const Physics&) {
  double nearest = 1e300;
  for (int n = 0; n < mesh.node_count(); ++n) {
    const double d = norm(mesh.X[NodeId(n)] - position);
    // of equally near ones, the lowest global id: numbering doesn't matter
    if (d < nearest || (d == nearest && mesh.node_gid[NodeId(n)] < mesh.node_gid[node_]))
      nearest = d, node_ = NodeId(n);
  }
  const auto elem = std::find_if(mesh.hex.begin(), mesh.hex.end(),
                                 [&](const auto& h) { return std::find(h.begin(), h.end(), node_) != h.end(); });
  if (elem != mesh.hex.end()) warn_if_far(mesh, "node", position, nearest, ElemId(elem - mesh.hex.begin()));
}
void NodeProbe::values(const Mesh&, const State& s, const Physics&, std::vector<double>& out) {
  const Vec3 &x = s.x[node_], &v = s.v[node_];
  out.insert(out.end(), {x.x, x.y, x.z, v.x, v.y, v.z});
}

void ElementProbe::select(const Mesh& mesh, const Physics& ph) {
  double nearest = 1e300;
  for (int e = 0; e < mesh.elem_count(); ++e) {
    Vec3 centre;
    for (NodeId n : mesh.hex[ElemId(e)]) centre += 0.125 * mesh.X[n];
    const double d = norm(centre - position);
    if (d < nearest || (d == nearest && mesh.elem_gid[ElemId(e)] < mesh.elem_gid[elem_]))
      nearest = d, elem_ = ElemId(e);
  }
  heats_ = heats(ph.elements, mesh.body[elem_]);
  warn_if_far(mesh, "element", position, nearest, elem_);
}
void ElementProbe::values(const Mesh&, const State& s, const Physics& ph, std::vector<double>& out) {
  const SlotId slot = ph.elements.blocks.slot[elem_];
  ElementResult r;
  double J = 0;
  if (ph.elements.blocks.is_own(slot)) {
    r = evaluate(ph.elements, s, slot, ph.filter ? ph.filter->mean_stress() : nullptr);
    J = s.volume[slot] / s.V0[slot];
  }
  if (const auto& ranks = ph.elements.ranks) {
    r = ranks->from_owner(ph.elements.blocks, elem_, r);
    J = ranks->from_owner(ph.elements.blocks, elem_, J);
  }
  out.insert(out.end(), {J, r.eqps, trace(r.sigma) / 3, von_mises(r.sigma), r.sigma.xx, r.sigma.yy, r.sigma.zz,
                         r.sigma.xy, r.sigma.xz, r.sigma.yz});
  if (heats_) out.push_back(r.temperature);
}

void RingProbe::select(const Mesh& mesh, const Physics&) {
  axis = unit(axis);
  std::vector<NodeId> candidates;
  if (nodes.empty()) {
    for (int n = 0; n < mesh.node_count(); ++n) candidates.push_back(NodeId(n));
  } else {
    candidates = node_set(mesh, nodes, place);
  }
  for (NodeId n : candidates)
    if (const double z = dot(mesh.X[n] - centre, axis); z >= lower && z <= upper) nodes_.push_back(n);
  is_in_.assign(size_t(mesh.node_count()), 0);
  for (NodeId n : nodes_) is_in_[size_t(n)] = 1;
  if (nodes_.empty()) throw InputError(fmt::format("{}: no node lies between lower and upper", place));
}
void RingProbe::values(const Mesh& mesh, const State& s, const Physics&, std::vector<double>& out) {
  for (NodeId n(int64_t(is_in_.size())); n < mesh.node_count(); n = NodeId(n + 1)) {
    const NodeId parent = mesh.parent[n];
    is_in_.push_back(parent.valid() && is_in_[size_t(parent)]);
    if (is_in_.back()) nodes_.push_back(n);
  }
  double mass = 0, radius = 0, radius_max = 0, v_radial = 0, v_axial = 0, z_mean = 0;
  for (NodeId n : nodes_) {
    const Vec3 r = s.x[n] - centre;
    const double z = dot(r, axis), distance = norm(r - z * axis);
    mass += s.m[n], radius += s.m[n] * distance, radius_max = std::max(radius_max, distance);
    v_axial += s.m[n] * dot(s.v[n], axis), z_mean += s.m[n] * z;
    if (distance > 0) v_radial += s.m[n] * dot(s.v[n], r - z * axis) / distance;
  }
  out.insert(out.end(), {radius / mass, radius_max, v_radial / mass, v_axial / mass, z_mean / mass});
}

void WallForceProbe::select(const Mesh&, const Physics& ph) {
  if (condition < 0 || size_t(condition) >= ph.conditions.size())
    throw InputError(
        fmt::format("{}: condition {} does not exist: the case has {}", place, condition, ph.conditions.size()));
}
void WallForceProbe::values(const Mesh&, const State& s, const Physics& ph, std::vector<double>& out) {
  const Vec3 impulse = std::visit([](const auto& c) { return c.reaction.impulse; }, ph.conditions[size_t(condition)]);
  const Vec3 f = s.dt > 0 ? (-1 / s.dt) * impulse : Vec3{};
  out.insert(out.end(), {f.x, f.y, f.z});
}

}  // namespace bw::csd
