// SPDX-License-Identifier: Apache-2.0
#include "csd/local_steps.h"

#include <algorithm>

#include "csd/element/blocks.h"

namespace bw::csd {

void LocalSteps::propose(const Blocks& blocks, std::vector<uint8_t> levels, const std::vector<char>& whole,
                         size_t nodes) {
  if (levels == block_ || (!on() && std::all_of(levels.begin(), levels.end(), [](uint8_t l) { return l == 0; })))
    return;
  next_.top = *std::max_element(levels.begin(), levels.end());
  next_.node = Field<uint8_t, NodeId>(nodes, uint8_t(next_.top));
  for (int block = 0; block < blocks.block_count(); ++block)
    for (int i = 0; i < 8 * lanes; ++i) {
      uint8_t& level = next_.node[NodeId(blocks.nodes_of(block)[i])];
      level = std::min(level, levels[size_t(block)]);
    }
  for (size_t n = 0; n < whole.size(); ++n)
    if (whole[n]) next_.node[NodeId(int64_t(n))] = uint8_t(next_.top);
  next_.block = std::move(levels);
}

void LocalSteps::take_next() {
  top_ = now_ = next_.top;
  block_ = std::move(next_.block), node_ = std::move(next_.node);
  next_ = {};
  evaluations_ = 0;
  for (const uint8_t level : block_) evaluations_ += double(1 << (top_ - level)) / double(block_.size());
  list_due();
}

void LocalSteps::set_level(std::span<const NodeId> nodes, int level) {
  if (!on()) return;
  for (const NodeId n : nodes) node_[n] = uint8_t(level);
}

void LocalSteps::append_copies(std::span<const NodeSplit> splits) {
  if (!on()) return;
  for (const NodeSplit& split : splits) {
    const uint8_t level = node_[split.parent];
    node_.push_back(level);
    for (size_t now = level; now < due_.size(); ++now) due_[now].push_back(split.child);
  }
}

void LocalSteps::list_due() {
  due_.assign(size_t(top_), {});
  for (int64_t n = 0; n < int64_t(node_.size()); ++n)
    for (int now = node_[NodeId(n)]; now < top_; ++now) due_[size_t(now)].push_back(int32_t(n));
}

}  // namespace bw::csd
