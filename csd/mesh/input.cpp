// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/input.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "common/math/random.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

namespace {

// Rodrigues' formula; multiples of 90 degrees about a coordinate axis are exact
Vec3 turned(const Vec3& x, const Vec3& axis, double degrees) {
  const double quarters = degrees / 90, a = degrees * std::numbers::pi / 180;
  const bool is_quarter = quarters == std::floor(quarters);
  const int q = is_quarter ? int(std::fmod(std::fmod(quarters, 4) + 4, 4)) : 0;
  constexpr int cosine[4] = {1, 0, -1, 0}, sine[4] = {0, 1, 0, -1};
  const double c = is_quarter ? cosine[q] : std::cos(a), s = is_quarter ? sine[q] : std::sin(a);
  return c * x + s * cross(axis, x) + ((1 - c) * dot(axis, x)) * axis;
}

void add_region(Mesh& mesh, const RegionSet& set, const std::vector<Face>& boundary) {
  const auto is_inside = [&](NodeId n) {
    const Vec3& p = mesh.X[n];
    return p.x >= set.lower.x && p.y >= set.lower.y && p.z >= set.lower.z && p.x <= set.upper.x && p.y <= set.upper.y &&
           p.z <= set.upper.z;
  };
  add_set(mesh, boundary, set.name, is_inside);
  auto& elems = mesh.elem_sets[set.name];
  for (int32_t e = 0; e < mesh.elem_count(); ++e) {
    const auto& h = mesh.hex[ElemId(e)];
    if (std::all_of(h.begin(), h.end(), is_inside)) elems.push_back(ElemId(e));
  }
}

template <class Id>
void append_sets(std::map<std::string, std::vector<Id>>& to, const std::map<std::string, std::vector<Id>>& from,
                 const std::string& body, const auto& shifted) {
  for (const auto& [name, items] : from)
    for (const std::string& key : {name, body + "." + name})
      for (const Id& item : items) to[key].push_back(shifted(item));
}

}  // namespace

void perturb_nodes(Mesh& mesh, double fraction, uint64_t seed) {
  Field<double, NodeId> shortest(size_t(mesh.node_count()), 1e300);
  for (const auto& h : mesh.hex)
    for (const auto& edge : hex_edge) {
      const NodeId a = h[size_t(edge[0])], b = h[size_t(edge[1])];
      const double length = norm(mesh.X[b] - mesh.X[a]);
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  for (const NodeId n : nodes_of_faces(mesh, boundary_faces(mesh))) shortest[n] = 0;
  const Field<Vec3, NodeId> still = mesh.X;
  Field<Vec3, NodeId> shift(size_t(mesh.node_count()));
  for (int32_t i = 0; i < mesh.node_count(); ++i) {
    const NodeId n(i);
    for (int d = 0; d < 3; ++d)
      shift[n][d] = fraction * shortest[n] * (2 * uniform01(seed, uint64_t(mesh.node_gid[n]), uint64_t(d)) - 1);
  }
  // where an element would lose more than half its scaled Jacobian, its nodes go half as far
  for (bool is_good = false; !is_good;) {
    is_good = true;
    for (int32_t i = 0; i < mesh.node_count(); ++i) mesh.X[NodeId(i)] = still[NodeId(i)] + shift[NodeId(i)];
    std::set<int32_t> too_far;
    for (const auto& h : mesh.hex)
      if (const double before = scaled_jacobian(corners(h, still));
          scaled_jacobian(corners(h, mesh.X)) < std::min(before, 0.5 * before))
        too_far.insert(h.begin(), h.end());
    for (const int32_t n : too_far) {
      shift[NodeId(n)] = 0.5 * shift[NodeId(n)];
      is_good = false;
    }
  }
}

Mesh make_mesh(const MeshInput& input, MeshQuality& quality) {
  Mesh mesh = std::visit([](const auto& kind) { return kind.make(); }, input.kind);
  const Vec3 axis = unit(input.turn_axis);
  for (Vec3& x : mesh.X) {
    x = input.scale * x;
    if (input.turn != 0) x = turned(x, axis, input.turn);
    x += input.move;
  }
  const std::string where = std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.file; }) return kind.file;
        return input.place;
      },
      input.kind);
  quality = check_mesh(mesh, where, input.may_have_pieces);
  if (input.perturb > 0) {
    perturb_nodes(mesh, input.perturb, uint64_t(input.seed));
    const MeshQuality before = quality;
    quality = check_mesh(mesh, where, input.may_have_pieces);
    quality.mended = before.mended;
    quality.notes.insert(quality.notes.begin(), before.notes.begin(), before.notes.end());
  }
  if (!input.sets.empty()) {
    const auto boundary = boundary_faces(mesh);
    for (const RegionSet& set : input.sets) {
      if (mesh.node_sets.contains(set.name) || mesh.face_sets.contains(set.name) || mesh.elem_sets.contains(set.name))
        throw InputError(set.place + ": the mesh has a set '" + set.name + "' already");
      add_region(mesh, set, boundary);
      if (mesh.node_sets[set.name].empty()) throw InputError(set.place + ": set '" + set.name + "' holds no node");
    }
  }
  return mesh;
}

Mesh merge(std::vector<Mesh> bodies, const std::vector<std::string>& names) {
  Mesh all;
  for (size_t b = 0; b < bodies.size(); ++b) {
    const Mesh& m = bodies[b];
    const int32_t nodes = all.node_count(), elems = all.elem_count();
    const auto node = [&](NodeId n) { return NodeId(nodes + n.value); };
    const auto elem = [&](ElemId e) { return ElemId(elems + e.value); };
    for (int32_t i = 0; i < m.node_count(); ++i) {
      all.X.push_back(m.X[NodeId(i)]);
      all.node_gid.push_back(nodes + m.node_gid[NodeId(i)]);
      all.parent.push_back(m.parent[NodeId(i)].valid() ? node(m.parent[NodeId(i)]) : NodeId());
    }
    auto& everything = all.elem_sets[names[b]];
    for (int32_t i = 0; i < m.elem_count(); ++i) {
      auto h = m.hex[ElemId(i)];
      for (NodeId& n : h) n = node(n);
      all.hex.push_back(h);
      all.body.push_back(int32_t(b));
      all.elem_gid.push_back(elems + m.elem_gid[ElemId(i)]);
      everything.push_back(ElemId(elems + i));
    }
    append_sets(all.node_sets, m.node_sets, names[b], node);
    append_sets(all.elem_sets, m.elem_sets, names[b], elem);
    append_sets(all.face_sets, m.face_sets, names[b], [&](Face f) { return Face{elem(f.elem), f.side}; });
  }
  return all;
}

}  // namespace bw::csd
