// SPDX-License-Identifier: Apache-2.0
// Elements in blocks of `lanes`, all of one body; the last block of a body is padded with copies of its last element.
// Blocks form chunks, chunks have colours: chunks of one colour share no node, so they add their forces in parallel,
// and a node receives its forces in the same order for any number of threads. Colours come from the uncracked mesh and
// stay valid: a crack only removes sharing.
// On several ranks all ranks know all blocks, and each computes its own: loops go over those (csd/ranks).
#pragma once
#include <algorithm>
#include <vector>

#include "common/math/pack.h"
#include "common/parallel/loop.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Place of an element in the AoSoA arrays: block * lanes + lane.
using SlotId = Id<struct SlotTag>;
inline constexpr int blocks_per_chunk = 16;

struct Chunk {
  int first = 0, last = 0;  ///< blocks [first, last)
  int body = 0;
};

/// Corners whose nodal sums other ranks contribute to: a block that has any puts their addends here instead of adding
/// them to the node (csd/ranks adds those of all ranks, in the order of one rank).
struct Border {
  std::vector<int32_t> row;  ///< [block] -1: none of its corners; empty: none anywhere
  Aligned<int32_t> place;    ///< [row][8][lanes] into the buffers; -1: adds to its node
  Vec3* vectors = nullptr;   ///< of this rank
  double* numbers = nullptr;

  /// Places of the block's corners, or null.
  const int32_t* of(int block) const {
    return row.empty() || row[size_t(block)] < 0 ? nullptr : place.data() + size_t(row[size_t(block)]) * 8 * lanes;
  }
};

struct Blocks {
  Aligned<int32_t> node;       ///< [block][8][lanes]
  std::vector<int> used;       ///< [block] lanes that are elements, the rest is padding
  Field<ElemId, SlotId> elem;  ///< padding: the element that it copies
  Field<SlotId, ElemId> slot;
  std::vector<int> first_block;             ///< [bodies + 1]
  std::vector<std::vector<Chunk>> colours;  ///< those with blocks of this rank
  std::vector<std::vector<int32_t>> own;    ///< [body] this rank's blocks, ascending; empty on one rank: all
  std::vector<int32_t> own_row;             ///< [block] place in own[body], -1: another rank's; empty on one rank
  Border border;

  int block_count() const { return int(used.size()); }
  int slot_count() const { return block_count() * lanes; }
  const int32_t* nodes_of(int block) const { return node.data() + size_t(block) * 8 * lanes; }
  /// Blocks of a body that this rank computes, and the place of one among them: where its history stands.
  int own_count(int body) const {
    return own.empty() ? first_block[size_t(body) + 1] - first_block[size_t(body)] : int(own[size_t(body)].size());
  }
  int row_of(int body, int block) const {
    return own_row.empty() ? block - first_block[size_t(body)] : own_row[size_t(block)];
  }
  bool is_own(int block) const { return own_row.empty() || own_row[size_t(block)] >= 0; }
  bool is_own(SlotId s) const { return is_own(s / lanes); }
  bool is_own(ElemId e) const { return is_own(slot[e]); }
  /// Takes over the element's connectivity after a crack.
  void renew(const Mesh& mesh, ElemId e);
};

/// work(block, body) for all blocks; it may add to nodal fields. Chunks of a colour in parallel, colour after colour.
template <class Work>
void for_coloured_blocks(const Blocks& blocks, const Work& work) {
  for (const auto& chunks : blocks.colours)
    parallel_for_dynamic(int64_t(chunks.size()), [&](int64_t i) {
      const Chunk& c = chunks[size_t(i)];
      for (int b = c.first; b < c.last; ++b)
        if (blocks.is_own(b)) work(b, c.body);
    });
}
/// visit(corner, lane) for the elements of a block in the order in which they add to their nodes.
template <class Visit>
void for_corners(int used, const Visit& visit) {
  for (int first = 0; first < used; first += Pack::size)
    for (int a = 0; a < 8; ++a)
      for (int l = first; l < std::min(used, first + Pack::size); ++l) visit(a, l);
}
/// Adds value(corner, lane) of each element of a block to the nodal sums. It must come from memory: a product would be
/// fused with the sum, but not with what a border sends.
template <class Value>
void add_to_corners(const Blocks& blocks, int block, const Value& value, Field<double, NodeId>& sum) {
  const int32_t *nodes = blocks.nodes_of(block), *places = blocks.border.of(block);
  for_corners(blocks.used[size_t(block)], [&](int a, int l) {
    const int i = a * lanes + l;
    if (places && places[i] >= 0)
      blocks.border.numbers[places[i]] = value(a, l);
    else
      sum[NodeId(nodes[i])] += value(a, l);
  });
}
/// The same for work that adds to no node. Some blocks cost nothing.
template <class Work>
void for_blocks(const Blocks& blocks, const Work& work) {
  const int bodies = int(blocks.first_block.size()) - 1;
  for (int body = 0; body < bodies; ++body) {
    const int first = blocks.first_block[size_t(body)], count = blocks.own_count(body);
    parallel_for_dynamic((count + blocks_per_chunk - 1) / blocks_per_chunk, [&](int64_t chunk) {
      const int begin = int(chunk) * blocks_per_chunk;
      for (int i = begin; i < std::min(count, begin + blocks_per_chunk); ++i)
        work(blocks.own.empty() ? first + i : blocks.own[size_t(body)][size_t(i)], body);
    });
  }
}

/// Blocks of the mesh as it is numbered; bodies 0 .. body_count-1.
Blocks make_blocks(const Mesh& mesh, int body_count);

/// Numbers elements by element_order (csd/mesh/order.h), nodes by first use. Global ids keep the input's order; sets
/// follow.
void renumber_for_locality(Mesh& mesh);

}  // namespace bw::csd
