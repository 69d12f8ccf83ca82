// SPDX-License-Identifier: Apache-2.0
#include "csd/ranks/ranks.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/timers.h"
#include "csd/ranks/partition.h"

namespace bw::csd {
namespace {

/// The chunks of a colour, cut down to runs of blocks of one rank.
std::vector<Chunk> own_runs(const std::vector<Chunk>& chunks, const std::vector<int32_t>& rank, int me) {
  std::vector<Chunk> runs;
  for (const Chunk& chunk : chunks)
    for (int b = chunk.first; b < chunk.last; ++b) {
      if (rank[size_t(b)] != me) continue;
      if (b > chunk.first && rank[size_t(b) - 1] == me)
        ++runs.back().last;
      else
        runs.push_back({b, b + 1, chunk.body});
    }
  return runs;
}

}  // namespace

Ranks::Ranks(const Comm& comm, const Mesh& mesh, Blocks& blocks) : comm_(comm) {
  // the root divides, so that all agree whatever METIS does
  const std::vector<int32_t> rank =
      comm.gather_all(comm.root() ? assign_blocks(mesh, blocks, comm.size()) : std::vector<int32_t>{});
  find_border(mesh, blocks, rank);
  divide(mesh, blocks, rank);
}

void Ranks::divide(const Mesh& mesh, Blocks& b, const std::vector<int32_t>& rank) {
  const int me = comm_.rank();
  elements_.resize(size_t(comm_.size())), blocks_.resize(size_t(comm_.size()));
  for (int e = 0; e < mesh.elem_count(); ++e) elements_[size_t(rank[size_t(b.slot[ElemId(e)] / lanes)])].push_back(e);
  b.own.resize(b.first_block.size() - 1);
  b.own_row.assign(size_t(b.block_count()), -1);
  for (size_t body = 0; body < b.own.size(); ++body)
    for (int block = b.first_block[body]; block < b.first_block[body + 1]; ++block) {
      blocks_[size_t(rank[size_t(block)])].push_back(block);
      if (rank[size_t(block)] != me) continue;
      b.own_row[size_t(block)] = int32_t(b.own[body].size());
      b.own[body].push_back(block);
    }
  for (auto& chunks : b.colours) chunks = own_runs(chunks, rank, me);
}

void Ranks::find_border(const Mesh& mesh, Blocks& b, const std::vector<int32_t>& rank) {
  constexpr int32_t nobody = -2, border = -1;
  home_.assign(size_t(mesh.node_count()), nobody);
  for (int s = 0; s < b.slot_count(); ++s)
    for (const NodeId n : mesh.hex[b.elem[SlotId(s)]]) {
      int32_t& home = home_[size_t(n)];
      const int32_t r = rank[size_t(s / lanes)];
      home = home == nobody || home == r ? r : border;
    }
  // the addends of all ranks, in the order of one
  addends_of_.assign(size_t(comm_.size()), 0);
  b.border.row.assign(size_t(b.block_count()), -1);
  std::vector<std::pair<NodeId, Addend>> found;
  for (const auto& chunks : b.colours)
    for (const Chunk& chunk : chunks)
      for (int block = chunk.first; block < chunk.last; ++block)
        for_corners(b.used[size_t(block)], [&](int a, int l) {
          const int32_t corner = (block * 8 + a) * lanes + l, r = rank[size_t(block)];
          const NodeId n(b.node[size_t(corner)]);
          if (home_[size_t(n)] != border) return;
          const int32_t place = addends_of_[size_t(r)]++;
          found.push_back({n, {corner, r, place}});
          if (r != comm_.rank()) return;
          int32_t& row = b.border.row[size_t(block)];
          if (row < 0) {
            row = int32_t(b.border.place.size()) / (8 * lanes);
            b.border.place.resize(b.border.place.size() + 8 * lanes, -1);
          }
          b.border.place[size_t((row * 8 + a) * lanes + l)] = place;
        });
  std::vector<int32_t> number(home_.size(), -1);
  int32_t count = 0;
  for (const auto& [n, addend] : found)
    if (number[size_t(n)] < 0) number[size_t(n)] = count++;
  addends_ = Csr<Addend>::build(count, [&](auto&& add) {
    for (const auto& [n, addend] : found) add(number[size_t(n)], addend);
  });
  inner_.resize(size_t(comm_.size()));
  for (size_t n = 0; n < home_.size(); ++n)
    if (home_[n] >= 0) inner_[size_t(home_[n])].push_back(int32_t(n));
  vectors_.mine.assign(size_t(addends_of_[size_t(comm_.rank())]), {});
  numbers_.mine.assign(vectors_.mine.size(), 0.0);
  b.border.vectors = vectors_.mine.data(), b.border.numbers = numbers_.mine.data();
}

std::string Ranks::shares() const {
  std::string counts;
  for (const auto& list : elements_) counts += fmt::format("{}{}", counts.empty() ? "" : " + ", list.size());
  return fmt::format("{} ranks ({} elements, {} nodes between them) of ", comm_.size(), counts, addends_.rows());
}

void Ranks::append_copies(std::span<const NodeSplit> splits) {
  for (const NodeSplit& split : splits) {
    const int32_t home = home_[size_t(split.parent)];
    home_.push_back(home);
    if (home >= 0) inner_[size_t(home)].push_back(split.child);
  }
}

template <class T>
void Ranks::sum(const Blocks& blocks, Buffer<T>& buffer, Field<T, NodeId>& a) {
  const Timed timed("exchange");
  constexpr int width = sizeof(T) / sizeof(double);
  const size_t ranks = size_t(comm_.size()), me = size_t(comm_.rank());
  std::vector<int> start{0}, doubles{0};
  for (size_t r = 0; r < ranks; ++r) {
    start.push_back(start.back() + addends_of_[r] + int(inner_[r].size()));
    doubles.push_back(width * start.back());
  }
  buffer.all.resize(size_t(start.back()));
  std::copy(buffer.mine.begin(), buffer.mine.end(), buffer.all.begin() + start[me]);
  std::fill(buffer.mine.begin(), buffer.mine.end(), T{});  // a block that is left out next time adds nothing
  const auto inner_nodes = [&](size_t r, const auto& work) {
    T* values = buffer.all.data() + start[r] + addends_of_[r];
    parallel_for(int64_t(inner_[r].size()), [&](int64_t i) { work(values[i], a[NodeId(inner_[r][size_t(i)])]); });
  };
  inner_nodes(me, [](T& sent, const T& sum) { sent = sum; });
  comm_.complete({reinterpret_cast<double*>(buffer.all.data()), size_t(doubles.back())}, doubles);
  for (size_t r = 0; r < ranks; ++r)
    if (r != me) inner_nodes(r, [](const T& sent, T& sum) { sum = sent; });
  parallel_for(addends_.rows(), [&](int64_t row) {
    for (const Addend& x : addends_[row])
      a[NodeId(blocks.node[size_t(x.corner)])] += buffer.all[size_t(start[size_t(x.rank)] + x.place)];
  });
}

void Ranks::sum(const Blocks& blocks, Field<Vec3, NodeId>& f) { sum(blocks, vectors_, f); }
void Ranks::sum(const Blocks& blocks, Field<double, NodeId>& a) { sum(blocks, numbers_, a); }

void Ranks::complete(const Lists& lists, double* values, size_t width) const {
  const Timed timed("exchange");
  std::vector<int> start{0};
  for (const auto& list : lists) start.push_back(start.back() + int(list.size() * width));
  std::vector<double> all(size_t(start.back()));
  const size_t me = size_t(comm_.rank());
  for (size_t i = 0; i < lists[me].size(); ++i)
    std::copy_n(values + size_t(lists[me][i]) * width, width, all.data() + size_t(start[me]) + i * width);
  comm_.complete(all, start);
  for (size_t r = 0; r < lists.size(); ++r)
    for (size_t i = 0; i < lists[r].size(); ++i)
      std::copy_n(all.data() + size_t(start[r]) + i * width, width, values + size_t(lists[r][i]) * width);
}

}  // namespace bw::csd
