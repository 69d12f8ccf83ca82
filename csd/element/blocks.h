// SPDX-License-Identifier: Apache-2.0
// Elements in blocks of `lanes`, all of one body; the last block of a body is padded with copies of its last element.
// Blocks form chunks, chunks have colours: chunks of one colour share no node, so they add their forces in parallel,
// and a node receives its forces in the same order for any number of threads. Colours come from the uncracked mesh and
// stay valid: a crack only removes sharing.
#pragma once
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

struct Blocks {
  Aligned<int32_t> node;       ///< [block][8][lanes]
  std::vector<int> used;       ///< [block] lanes that are elements, the rest is padding
  Field<ElemId, SlotId> elem;  ///< padding: the element that it copies
  Field<SlotId, ElemId> slot;
  std::vector<int> first_block;  ///< [bodies + 1]
  std::vector<std::vector<Chunk>> colours;

  int block_count() const { return int(used.size()); }
  int slot_count() const { return block_count() * lanes; }
  const int32_t* nodes_of(int block) const { return node.data() + size_t(block) * 8 * lanes; }
  /// Takes over the element's connectivity after a crack.
  void renew(const Mesh& mesh, ElemId e);
};

/// work(block, body) for all blocks; it may add to nodal fields. Chunks of a colour in parallel, colour after colour.
template <class Work>
void for_coloured_blocks(const Blocks& blocks, const Work& work) {
  for (const auto& chunks : blocks.colours)
    parallel_for_dynamic(int64_t(chunks.size()), [&](int64_t i) {
      const Chunk& c = chunks[size_t(i)];
      for (int b = c.first; b < c.last; ++b) work(b, c.body);
    });
}
/// The same for work that adds to no node.
template <class Work>
void for_blocks(const Blocks& blocks, const Work& work) {
  const int bodies = int(blocks.first_block.size()) - 1;
  for (int body = 0; body < bodies; ++body) {
    const int first = blocks.first_block[size_t(body)];
    parallel_for(blocks.first_block[size_t(body) + 1] - first, [&](int64_t i) { work(first + int(i), body); });
  }
}

/// Blocks of the mesh as it is numbered; bodies 0 .. body_count-1.
Blocks make_blocks(const Mesh& mesh, int body_count);

/// Numbers elements by body and then along a Hilbert curve through their centroids, nodes by first use. Global ids keep
/// the input's order; sets follow.
void renumber_for_locality(Mesh& mesh);

}  // namespace bw::csd
