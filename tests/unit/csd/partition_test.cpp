// SPDX-License-Identifier: Apache-2.0
// Blocks of elements for several ranks: equal loads, short borders.
#include <numeric>

#include "csd/ranks/partition.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

TEST(Partition, loads_are_equal_and_borders_short) {
  Mesh mesh = box({0, 0, 0}, {3, 1, 1}, {36, 12, 12});  // 5184 elements; a cut across has 169 nodes
  renumber_for_locality(mesh);
  const Blocks blocks = make_blocks(mesh, 1);
  for (const int ranks : {2, 3, 4}) {
    const std::vector<int32_t> rank = assign_blocks(mesh, blocks, ranks);
    std::vector<int> elements(static_cast<size_t>(ranks), 0);
    std::vector<std::vector<char>> touches(size_t(mesh.node_count()), std::vector<char>(size_t(ranks), 0));
    for (int e = 0; e < mesh.elem_count(); ++e) {
      const size_t r = size_t(rank[size_t(blocks.slot[ElemId(e)] / lanes)]);
      ++elements[r];
      for (NodeId n : mesh.hex[ElemId(e)]) touches[size_t(n)][r] = 1;
    }
    int border = 0;
    for (const auto& t : touches) border += std::accumulate(t.begin(), t.end(), 0) > 1;
    for (const int count : elements) EXPECT_NEAR(count, 5184 / ranks, 0.02 * 5184 / ranks) << ranks << " ranks";
    EXPECT_LE(border, 1.5 * 169 * (ranks - 1)) << ranks << " ranks";
    record(("border_nodes_" + std::to_string(ranks)).c_str(), border);
    EXPECT_EQ(rank, assign_blocks(mesh, blocks, ranks));
  }
}

TEST(Partition, refuses_more_ranks_than_blocks) {
  const Mesh mesh = box({0, 0, 0}, {1, 1, 1}, {2, 2, 3});
  const Blocks blocks = make_blocks(mesh, 1);
  EXPECT_EQ(assign_blocks(mesh, blocks, 2).size(), 2u);
  EXPECT_THROW(assign_blocks(mesh, blocks, 3), InputError);
}

}  // namespace
}  // namespace bw::csd
