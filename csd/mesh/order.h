// SPDX-License-Identifier: Apache-2.0
// In which order elements are kept. Blocks are made of `lanes` elements that follow each other, so that the order
// decides how many nodes a block gathers, and how straight a border between ranks can be.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "csd/mesh/faces.h"

namespace bw::csd {

/// [element][side] of pair_faces
using FacePartners = Field<std::array<int32_t, 6>, ElemId>;

/// order[new] = old. By body; within each the better of the two below, by nodes a block.
std::vector<ElemId> element_order(const Mesh& mesh);

/// Along a Hilbert curve through the centroids: good for any mesh, but its blocks are bricks only where the mesh's
/// sides are powers of two.
std::vector<ElemId> hilbert_order(const Mesh& mesh, const std::vector<ElemId>& elems);

/// Blocks grown from the mesh: elements are joined over a face in pairs, these over the most faces in fours, these in
/// eights, bricks of 2 x 2 x 2 wherever the input runs along the mesh's lines; what finds no partner is packed along
/// the curve. Blocks follow the curve through their centroids.
std::vector<ElemId> brick_order(const Mesh& mesh, const FacePartners& partner, const std::vector<ElemId>& elems);

/// Different nodes of each `lanes` elements of the order, summed.
int64_t nodes_of_blocks(const Mesh& mesh, const std::vector<ElemId>& order);

}  // namespace bw::csd
