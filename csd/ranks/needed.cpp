// SPDX-License-Identifier: Apache-2.0
#include "csd/ranks/needed.h"

#include "csd/load/loads.h"

namespace bw::csd {
namespace {

std::vector<NodeId> all_nodes(const Mesh& mesh) {
  std::vector<NodeId> nodes(size_t(mesh.node_count()));
  for (size_t n = 0; n < nodes.size(); ++n) nodes[n] = NodeId(int64_t(n));
  return nodes;
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
  for (const LoadCase& load : loads) mark(nodes_of_load(mesh, load.kind));
  for (const ConditionKind& condition : conditions)
    std::visit([&](const auto& kind) { mark(nodes_of_condition(mesh, kind)); }, condition);
  return is_needed;
}

}  // namespace bw::csd
