// SPDX-License-Identifier: Apache-2.0
#include "csd/archive.h"

#include <fmt/format.h>

#include "common/app/error.h"

namespace bw::csd {

template <class Visit>
void Archive::for_keys(Keys& keys, const Visit& visit) {
  visit("blocks", keys.blocks);
  visit("elements", keys.elements);
  visit("nodes", keys.nodes);
  for (size_t body = 0; body < keys.of_body.size(); ++body)
    visit(fmt::format("blocks_of_body_{}", body), keys.of_body[body]);
}

Archive::Keys Archive::keys_of(const Mesh& mesh, const Elements& el) {
  Keys keys;
  keys.all_blocks = size_t(el.blocks.block_count());
  keys.all_elements = size_t(mesh.elem_count());
  keys.all_nodes = size_t(mesh.node_count());
  keys.of_body.resize(el.blocks.first_block.size() - 1);
  std::vector<char> is_mine(keys.all_nodes, 0);
  for (size_t body = 0; body < keys.of_body.size(); ++body)
    for (int block = el.blocks.first_block[body]; block < el.blocks.first_block[body + 1]; ++block) {
      if (!el.blocks.is_own(block)) continue;
      keys.blocks.mine.push_back(block);
      keys.of_body[body].name.push_back(block);
      keys.of_body[body].mine.push_back(el.blocks.row_of(int(body), block));
      for (int l = 0; l < el.blocks.used[size_t(block)]; ++l) {
        const ElemId e = el.blocks.elem[SlotId(block * lanes + l)];
        keys.elements.mine.push_back(e);
        for (const NodeId n : mesh.hex[e]) is_mine[size_t(n)] = 1;
      }
    }
  for (size_t n = 0; n < is_mine.size(); ++n)
    if (is_mine[n]) keys.nodes.mine.push_back(int32_t(n));
  for (Rows* rows : {&keys.blocks, &keys.elements, &keys.nodes}) rows->name = rows->mine;
  return keys;
}

Archive::Archive(const Saved& to, const Mesh& mesh, const Elements& elements) : to_(to) {
  Keys keys = keys_of(mesh, elements);
  for_keys(keys, [&](const std::string& name, const Rows& rows) { to.rows(name, rows.name); });
  keys_ = std::make_shared<const Keys>(std::move(keys));
}

Archive::Archive(const Restored& from, const Mesh& mesh, const Elements& elements) : from_(from) {
  Keys keys = keys_of(mesh, elements);
  for_keys(keys, [&](const std::string& name, Rows& rows) {
    const std::vector<int32_t> known = from.rows<int32_t>(name);
    std::vector<int64_t> place(known.empty() ? 0 : size_t(*std::max_element(known.begin(), known.end())) + 1, -1);
    for (size_t i = 0; i < known.size(); ++i) place[size_t(known[i])] = int64_t(i);
    for (const int32_t key : rows.name) {
      if (size_t(key) >= place.size() || place[size_t(key)] < 0)
        throw InputError(fmt::format("the checkpoint doesn't fit the case's mesh: {} {} is missing", name, key));
      rows.place.push_back(place[size_t(key)]);
    }
  });
  keys_ = std::make_shared<const Keys>(std::move(keys));
}

Archive Archive::section(const std::string& name) const {
  Archive inside;
  inside.keys_ = keys_;
  if (to_) inside.to_ = to_->section(name);
  if (from_) inside.from_ = from_->section(name);
  return inside;
}

}  // namespace bw::csd
