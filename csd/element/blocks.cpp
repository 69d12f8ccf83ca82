// SPDX-License-Identifier: Apache-2.0
#include "csd/element/blocks.h"

#include <algorithm>

#include "common/app/error.h"
#include "common/math/pack.h"
#include "csd/mesh/order.h"

namespace bw::csd {

void Blocks::renew(const Mesh& mesh, ElemId e) {
  const int block = slot[e] / lanes;
  int32_t* n = node.data() + size_t(block) * 8 * lanes;
  for (int l = 0; l < lanes; ++l)
    if (elem[SlotId(block * lanes + l)] == e)  // its padding copies too
      for (int a = 0; a < 8; ++a) n[a * lanes + l] = mesh.hex[e][size_t(a)];
}

namespace {

void add_body(const std::vector<ElemId>& elems, Blocks& b) {
  for (size_t first = 0; first < elems.size(); first += lanes) {
    const int used = int(std::min<size_t>(lanes, elems.size() - first));
    for (int l = 0; l < lanes; ++l) b.elem.push_back(elems[first + size_t(std::min(l, used - 1))]);
    b.used.push_back(used);
  }
}

/// Greedy, in chunk order: the lowest colour that no chunk sharing a node has.
void colour(const Mesh& mesh, const std::vector<Chunk>& chunks, Blocks& b) {
  std::vector<std::vector<char>> taken(size_t(mesh.node_count()));  // colours seen at the node
  for (const Chunk& chunk : chunks) {
    std::vector<NodeId> nodes;
    for (int s = chunk.first * lanes; s < chunk.last * lanes; ++s)
      for (NodeId n : mesh.hex[b.elem[SlotId(s)]]) nodes.push_back(n);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<char> forbidden(b.colours.size() + 1, 0);
    for (NodeId n : nodes)
      for (char c : taken[size_t(n)]) forbidden[size_t(c)] = 1;
    const size_t free = size_t(std::find(forbidden.begin(), forbidden.end(), 0) - forbidden.begin());
    BW_CHECK(free < 127);
    if (free == b.colours.size()) b.colours.emplace_back();
    b.colours[free].push_back(chunk);
    for (NodeId n : nodes) taken[size_t(n)].push_back(char(free));
  }
}

}  // namespace

Blocks make_blocks(const Mesh& mesh, int body_count) {
  std::vector<std::vector<ElemId>> elems(static_cast<size_t>(body_count));
  for (int e = 0; e < mesh.elem_count(); ++e) elems[size_t(mesh.body[ElemId(e)])].push_back(ElemId(e));
  Blocks b;
  std::vector<Chunk> chunks;
  for (int body = 0; body < body_count; ++body) {
    b.first_block.push_back(b.block_count());
    add_body(elems[size_t(body)], b);
    for (int first = b.first_block.back(); first < b.block_count(); first += blocks_per_chunk)
      chunks.push_back({first, std::min(first + blocks_per_chunk, b.block_count()), body});
  }
  b.first_block.push_back(b.block_count());
  b.slot = Field<SlotId, ElemId>(size_t(mesh.elem_count()));
  for (int s = b.slot_count() - 1; s >= 0; --s) b.slot[b.elem[SlotId(s)]] = SlotId(s);
  b.node.resize(size_t(b.slot_count()) * 8);
  for (int e = 0; e < mesh.elem_count(); ++e) b.renew(mesh, ElemId(e));
  colour(mesh, chunks, b);
  return b;
}

void renumber_for_locality(Mesh& mesh) {
  const std::vector<ElemId> order = element_order(mesh);
  std::vector<NodeId> new_node(size_t(mesh.node_count()));
  std::vector<ElemId> new_elem(order.size());
  Mesh m;
  const auto number = [&](NodeId old) {
    if (!new_node[size_t(old)].valid()) {
      new_node[size_t(old)] = NodeId(m.node_count());
      m.X.push_back(mesh.X[old]);
      m.node_gid.push_back(mesh.node_gid[old]);
    }
    return new_node[size_t(old)];
  };
  for (ElemId old : order) {
    new_elem[size_t(old)] = ElemId(m.elem_count());
    auto hex = mesh.hex[old];
    for (NodeId& n : hex) n = number(n);
    m.hex.push_back(hex);
    m.body.push_back(mesh.body[old]);
    m.elem_gid.push_back(mesh.elem_gid[old]);
  }
  for (int n = 0; n < mesh.node_count(); ++n) number(NodeId(n));  // nodes of no element come last
  m.parent.resize(mesh.X.size());
  for (int n = 0; n < mesh.node_count(); ++n)
    if (const NodeId p = mesh.parent[NodeId(n)]; p.valid()) m.parent[new_node[size_t(n)]] = new_node[size_t(p)];
  for (auto& [name, set] : mesh.node_sets)
    for (NodeId n : set) m.node_sets[name].push_back(new_node[size_t(n)]);
  for (auto& [name, set] : mesh.elem_sets)
    for (ElemId e : set) m.elem_sets[name].push_back(new_elem[size_t(e)]);
  for (auto& [name, set] : mesh.face_sets)
    for (Face f : set) m.face_sets[name].push_back({new_elem[size_t(f.elem)], f.side});
  mesh = std::move(m);
}

}  // namespace bw::csd
