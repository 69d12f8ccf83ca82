// SPDX-License-Identifier: Apache-2.0
#include "csd/ranks/needed.h"

#include <concepts>

namespace bw::csd {
namespace {

template <class T, class... Listed>
concept OneOf = (std::same_as<T, Listed> || ...);

}  // namespace

std::vector<char> nodes_needed_everywhere(const Mesh& mesh, const std::vector<LoadCase>& loads,
                                          const std::vector<ConditionKind>& conditions) {
  std::vector<char> is_needed(size_t(mesh.node_count()), 0);
  bool all = false;
  for (const LoadCase& load : loads)
    std::visit(
        [&]<class L>(const L& kind) {
          if constexpr (OneOf<L, Pressure, PressureFront>) {
            for (const Face f : face_sets(mesh, kind.faces, kind.place))
              for (const NodeId n : mesh.nodes_of(f)) is_needed[size_t(n)] = 1;
          } else {
            all = true;
          }
        },
        load.kind);
  for (const ConditionKind& condition : conditions)
    std::visit(
        [&]<class C>(const C& kind) {
          if constexpr (OneOf<C, Fixed, Roller, PrescribedVelocity>) {
            for (const NodeId n : kind.reaction.nodes) is_needed[size_t(n)] = 1;
          } else {
            all = true;
          }
        },
        condition);
  if (all) is_needed.assign(is_needed.size(), 1);
  return is_needed;
}

}  // namespace bw::csd
