// SPDX-License-Identifier: Apache-2.0
#include "csd/fracture/cut.h"

#include <algorithm>
#include <map>

#include "csd/mesh/star.h"

namespace bw::csd {
namespace {

bool is_one_group(int32_t a, int32_t b) { return a == b || (a < 0 && b < 0); }

/// The part of its group that an element hangs together with by bonded faces, among elements not seen yet.
std::vector<ElemId> part_of(const Topology& topology, const Field<int32_t, ElemId>& group, ElemId first,
                            std::map<int32_t, bool>& is_seen) {
  std::vector<ElemId> part{first};
  is_seen[first] = true;
  for (size_t i = 0; i < part.size(); ++i)
    for (int side = 0; side < 6; ++side) {
      const Face g = topology.neighbour({part[i], side});
      if (!g.elem.valid() || group[g.elem] != group[first] || is_seen[g.elem]) continue;
      is_seen[g.elem] = true;
      part.push_back(g.elem);
    }
  return part;
}

/// The group that a part shares most bonded faces with, among those of the row; -1: none.
int32_t neighbour_of(const Topology& topology, const Field<int32_t, ElemId>& group, std::span<const ElemId> part,
                     int32_t lowest, int32_t highest) {
  std::map<int32_t, int> faces;
  for (const ElemId e : part)
    for (int side = 0; side < 6; ++side)
      if (const Face g = topology.neighbour({e, side}); g.elem.valid() && group[g.elem] != group[e])
        if (const int32_t k = group[g.elem]; k >= lowest && k <= highest) ++faces[k];
  int32_t best = -1;
  for (const auto& [k, count] : faces)
    if (best < 0 || count > faces[best]) best = k;
  return best;
}

}  // namespace

int64_t cut_between(Mesh& mesh, Topology& topology, const Field<int32_t, ElemId>& group, std::span<const ElemId> elems,
                    std::vector<NodeSplit>& splits, std::vector<ElemId>& changed) {
  const size_t lips = topology.boundary().size();
  std::vector<NodeId> nodes;
  for (const ElemId e : elems) nodes.insert(nodes.end(), mesh.hex[e].begin(), mesh.hex[e].end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  std::vector<int> part;
  for (const NodeId n : nodes) {
    const auto is_joined = [&](ElemId a, ElemId b) { return is_one_group(group[a], group[b]); };
    const int parts = star_parts(topology, mesh, n, part, is_joined);
    if (parts == 1) continue;
    const auto star = topology.elements(n);
    std::vector<std::vector<ElemId>> members(static_cast<size_t>(parts));
    for (size_t i = 0; i < star.size(); ++i) members[size_t(part[i])].push_back(star[i]);
    for (size_t k = 1; k < members.size(); ++k) {
      splits.push_back({n, topology.split(mesh, n, members[k])});
      changed.insert(changed.end(), members[k].begin(), members[k].end());
    }
  }
  return int64_t(topology.boundary().size() - lips) / 2;
}

int64_t join_strays(const Topology& topology, const Field<double, ElemId>& volume, std::span<const ElemId> elems,
                    Field<int32_t, ElemId>& group) {
  if (elems.empty()) return 0;
  int32_t lowest = group[elems[0]], highest = lowest;
  for (const ElemId e : elems) lowest = std::min(lowest, group[e]), highest = std::max(highest, group[e]);
  int64_t moved = 0;
  constexpr int most_passes = 10;  // a stray may join another one
  bool is_changed = true;
  for (int pass = 0; is_changed && pass < most_passes; ++pass) {
    is_changed = false;
    struct Part {
      double volume = 0;
      std::vector<ElemId> elems;
    };
    std::map<int32_t, std::vector<Part>> parts;
    std::map<int32_t, bool> is_seen;
    for (const ElemId e : elems) {
      if (is_seen[e]) continue;
      Part part{0, part_of(topology, group, e, is_seen)};
      for (const ElemId member : part.elems) part.volume += volume[member];
      parts[group[e]].push_back(std::move(part));
    }
    for (auto& [k, list] : parts) {
      if (list.size() < 2) continue;
      const auto main =
          std::max_element(list.begin(), list.end(), [](const Part& a, const Part& b) { return a.volume < b.volume; });
      for (auto part = list.begin(); part != list.end(); ++part) {
        if (part == main) continue;
        const int32_t to = neighbour_of(topology, group, part->elems, lowest, highest);
        if (to < 0) continue;
        for (const ElemId e : part->elems) group[e] = to;
        moved += int64_t(part->elems.size());
        is_changed = true;
      }
    }
  }
  return moved;
}

}  // namespace bw::csd
