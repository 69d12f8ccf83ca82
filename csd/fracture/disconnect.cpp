// SPDX-License-Identifier: Apache-2.0
#include "csd/fracture/disconnect.h"

#include <algorithm>

#include "csd/mesh/hex.h"

namespace bw::csd {

int shared_nodes(const Mesh& mesh, const Topology& topology, Face f) {
  if (topology.is_bonded(f)) return 4;
  const Face g = topology.partner(f);
  if (!g.elem.valid()) return 0;
  const auto a = mesh.nodes_of(f), b = mesh.nodes_of(g);
  return int(std::count_if(a.begin(), a.end(), [&](NodeId n) { return std::find(b.begin(), b.end(), n) != b.end(); }));
}

Vec3 face_area(const Mesh& mesh, Face f, std::span<const Vec3> x) {
  const auto at = [&](NodeId n) {
    while (size_t(n.value) >= x.size()) n = mesh.parent[n];
    return x[size_t(n.value)];
  };
  const auto q = mesh.nodes_of(f);
  return 0.5 * cross(at(q[2]) - at(q[0]), at(q[3]) - at(q[1]));
}

int choose_face(const Mesh& mesh, const Topology& topology, ElemId e, std::span<const Vec3> x, const Sym3& sigma) {
  double tension[6], largest = 0;
  for (int side = 0; side < 6; ++side) {
    tension[side] = 0;
    const Face f{e, side};
    if (shared_nodes(mesh, topology, f) == 0) continue;
    const Vec3 area = face_area(mesh, f, x);
    const double square = dot(area, area);
    if (square > 0) tension[side] = dot(area, sigma * area) / square;  // n.sigma.n
    largest = std::max(largest, tension[side]);
  }
  if (!(largest > 0)) return -1;
  for (int side = 0; side < 6; ++side)
    if (tension[side] >= (1 - 1e-9) * largest) return side;
  return -1;
}

namespace {

// splits the parts of a node's star that no bonded face joins; the part of the lowest element keeps the node
void separate_parts(Mesh& mesh, Topology& topology, NodeId n, std::vector<NodeSplit>& splits,
                    std::vector<ElemId>& changed) {
  std::vector<int> part;
  const int parts = topology.star_parts(mesh, n, part);
  if (parts == 1) return;
  const auto star = topology.elements(n);
  std::vector<std::vector<ElemId>> members(static_cast<size_t>(parts));
  for (size_t i = 0; i < star.size(); ++i) members[size_t(part[i])].push_back(star[i]);
  for (int k = 1; k < parts; ++k) {
    const auto& moved = members[size_t(k)];
    splits.push_back({n, topology.split(mesh, n, moved)});
    changed.insert(changed.end(), moved.begin(), moved.end());
  }
}

}  // namespace

int detach_face(Mesh& mesh, Topology& topology, Face f, std::vector<NodeSplit>& splits, std::vector<ElemId>& changed) {
  const Face other = topology.partner(f);
  if (!other.elem.valid()) return 0;
  const size_t before = splits.size(), lips = topology.boundary().size();
  std::vector<NodeId> touched;
  for (const int local : face_nodes[f.side]) {
    const NodeId ip = mesh.hex[f.elem][size_t(local)], jp = mesh.hex[f.elem][size_t(across(f.side, local))];
    const auto there = mesh.nodes_of(other);
    if (std::find(there.begin(), there.end(), ip) == there.end())
      continue;                 // differs from eq (16), which would crack elsewhere: open already
    std::vector<ElemId> moved;  // eq (16): all elements that contain the edge (ip, jp)
    const auto star = topology.elements(ip);
    for (const ElemId e : star)
      if (std::find(mesh.hex[e].begin(), mesh.hex[e].end(), jp) != mesh.hex[e].end()) moved.push_back(e);
    if (moved.size() == star.size()) continue;  // nothing to separate
    const NodeId child = topology.split(mesh, ip, moved);
    splits.push_back({ip, child});
    changed.insert(changed.end(), moved.begin(), moved.end());
    touched.push_back(ip);
    touched.push_back(child);
  }
  // hinges can arise at the nodes of faces that lost their bond, nowhere else
  for (size_t i = lips; i < topology.boundary().size(); ++i)
    for (const NodeId n : mesh.nodes_of(topology.boundary()[i])) touched.push_back(n);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  for (const NodeId n : touched) separate_parts(mesh, topology, n, splits, changed);
  return int(splits.size() - before);
}

}  // namespace bw::csd
