// SPDX-License-Identifier: Apache-2.0
#include "csd/ranks/needed.h"

#include "csd/load/sets.h"

namespace bw::csd {
namespace {

std::vector<NodeId> all_nodes(const Mesh& mesh) {
  std::vector<NodeId> nodes(size_t(mesh.node_count()));
  for (size_t n = 0; n < nodes.size(); ++n) nodes[n] = NodeId(int64_t(n));
  return nodes;
}

/// Nodes whose forces a load sums, and whose velocities its work asks for.
template <class L>
std::vector<NodeId> nodes_of_load(const Mesh& mesh, const L& load) {
  if constexpr (requires { load.faces; }) {
    return nodes_of_faces(mesh, face_sets(mesh, load.faces, load.place));
  } else if constexpr (requires { load.elements; }) {
    if (load.elements.empty()) return all_nodes(mesh);
    std::vector<NodeId> nodes;
    for (const ElemId e : elem_set(mesh, load.elements, load.place))
      nodes.insert(nodes.end(), mesh.hex[e].begin(), mesh.hex[e].end());
    return nodes;
  } else {
    return all_nodes(mesh);
  }
}
template <class C>
std::vector<NodeId> nodes_of_condition(const Mesh&, const C& condition) {
  return condition.reaction.nodes;
}
std::vector<NodeId> nodes_of_condition(const Mesh& mesh, const RigidWall& wall) {
  return wall.separation == "rebound" ? all_nodes(mesh) : wall.reaction.nodes;  // its bodies' momenta are looked at
}

}  // namespace

std::vector<char> nodes_needed_everywhere(const Mesh& mesh, const std::vector<LoadCase>& loads,
                                          const std::vector<ConditionKind>& conditions) {
  std::vector<char> is_needed(size_t(mesh.node_count()), 0);
  const auto mark = [&](const std::vector<NodeId>& nodes) {
    for (const NodeId n : nodes) is_needed[size_t(n)] = 1;
  };
  for (const LoadCase& load : loads) std::visit([&](const auto& kind) { mark(nodes_of_load(mesh, kind)); }, load.kind);
  for (const ConditionKind& condition : conditions)
    std::visit([&](const auto& kind) { mark(nodes_of_condition(mesh, kind)); }, condition);
  return is_needed;
}

}  // namespace bw::csd
