// SPDX-License-Identifier: Apache-2.0
// Cracks between groups of elements, on the faces that are there.
#pragma once
#include <span>
#include <vector>

#include "csd/mesh/topology.h"

namespace bw::csd {

/// Opens all faces between elements of different groups that touch one of `elems`. group [element] >= 0: one group each
/// value; all others (< 0) are one group. Each node's elements are parted into those that bonded faces inside a group
/// join; the part of the lowest element keeps the node, and so no hinges remain. What is open stays as it is. Appends
/// the splits in order and the elements that got new nodes (with repetitions). Returns the number of faces opened.
int64_t cut_between(Mesh& mesh, Topology& topology, const Field<int32_t, ElemId>& group, std::span<const ElemId> elems,
                    std::vector<NodeSplit>& splits, std::vector<ElemId>& changed);

/// Makes every group hang together by bonded faces: of the parts of a group among `elems` the one of the largest volume
/// keeps the group, the others join the group that they share most faces with (then the lowest), and stay if there is
/// none. Returns the number of elements that changed their group.
int64_t join_strays(const Topology& topology, const Field<double, ElemId>& volume, std::span<const ElemId> elems,
                    Field<int32_t, ElemId>& group);

}  // namespace bw::csd
