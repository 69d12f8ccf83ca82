// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <vector>

#include "csd/mesh/topology.h"

namespace bw::csd {

/// Number of groups into which the elements of a node fall when only bonded faces that contain the node and for whose
/// elements joins(a, b) holds join them; part: the group of each of topology.elements(n), by their first element.
template <class Joins>
int star_parts(const Topology& topology, const Mesh& mesh, NodeId n, std::vector<int>& part, const Joins& joins) {
  const auto star = topology.elements(n);
  part.assign(star.size(), -1);
  int parts = 0;
  std::vector<size_t> open;
  for (size_t i = 0; i < star.size(); ++i) {
    if (part[i] >= 0) continue;
    part[i] = parts;
    open.assign(1, i);
    while (!open.empty()) {
      const ElemId e = star[open.back()];
      open.pop_back();
      for (int side = 0; side < 6; ++side) {
        const Face f{e, side};
        if (!topology.is_bonded(f) || !joins(e, topology.partner(f).elem)) continue;
        const auto q = mesh.nodes_of(f);
        if (std::find(q.begin(), q.end(), n) == q.end()) continue;
        const size_t j = size_t(std::lower_bound(star.begin(), star.end(), topology.partner(f).elem) - star.begin());
        if (part[j] >= 0) continue;
        part[j] = parts;
        open.push_back(j);
      }
    }
    ++parts;
  }
  return parts;
}

}  // namespace bw::csd
