// SPDX-License-Identifier: Apache-2.0
#include "csd/ranks/partition.h"

#include <fmt/format.h>
#include <metis.h>

#include <algorithm>

#include "common/app/error.h"
#include "common/data/csr.h"

namespace bw::csd {
namespace {

/// Blocks that share nodes, weighted by how many.
struct Graph {
  std::vector<idx_t> start{0}, to, shared, elements;
};

Graph graph_of(const Mesh& mesh, const Blocks& b) {
  const auto visit_corners = [&](auto&& visit) {
    for (int block = 0; block < b.block_count(); ++block)
      for (int l = 0; l < b.used[size_t(block)]; ++l)
        for (int a = 0; a < 8; ++a) visit(block, NodeId(b.nodes_of(block)[a * lanes + l]));
  };
  const auto blocks_of = Csr<int32_t>::build(
      mesh.node_count(), [&](auto&& add) { visit_corners([&](int block, NodeId n) { add(n, block); }); });
  Graph g;
  std::vector<idx_t> count(size_t(b.block_count()), 0);
  std::vector<int32_t> nodes, near;
  for (int block = 0; block < b.block_count(); ++block) {
    nodes.assign(b.nodes_of(block), b.nodes_of(block) + 8 * lanes);  // padding repeats nodes that are there
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    near.clear();
    for (const int32_t n : nodes) {
      int32_t last = -1;  // a block stands several times in the list of its node
      for (const int32_t other : blocks_of[n]) {
        if (other == block || other == last) continue;
        if (count[size_t(other)]++ == 0) near.push_back(other);
        last = other;
      }
    }
    std::sort(near.begin(), near.end());
    for (const int32_t other : near) {
      g.to.push_back(other);
      g.shared.push_back(count[size_t(other)]);
      count[size_t(other)] = 0;
    }
    g.start.push_back(idx_t(g.to.size()));
    g.elements.push_back(b.used[size_t(block)]);
  }
  return g;
}

}  // namespace

std::vector<int32_t> assign_blocks(const Mesh& mesh, const Blocks& blocks, int ranks) {
  if (ranks > blocks.block_count())
    throw InputError(
        fmt::format("csd was started on {} ranks, but {} elements make only {} blocks of {}, which are not divided: "
                    "use fewer ranks",
                    ranks, mesh.elem_count(), blocks.block_count(), lanes));
  std::vector<int32_t> rank(size_t(blocks.block_count()), 0);
  if (ranks == 1) return rank;
  Graph g = graph_of(mesh, blocks);
  idx_t count = idx_t(rank.size()), conditions = 1, parts = ranks, cut = 0;
  std::vector<idx_t> part(rank.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NCUTS] = 8;  // the best of several: blocks are coarse
  const int code =
      METIS_PartGraphRecursive(&count, &conditions, g.start.data(), g.to.data(), g.elements.data(), nullptr,
                               g.shared.data(), &parts, nullptr, nullptr, options, &cut, part.data());
  BW_CHECK(code == METIS_OK);
  std::copy(part.begin(), part.end(), rank.begin());
  return rank;
}

}  // namespace bw::csd
