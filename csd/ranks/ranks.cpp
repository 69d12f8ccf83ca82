// SPDX-License-Identifier: Apache-2.0
#include "csd/ranks/ranks.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/timers.h"
#include "csd/ranks/partition.h"
#include "csd/state.h"

namespace bw::csd {
Ranks::Ranks(const Comm& comm, const Mesh& mesh, Blocks& blocks) : comm_(comm) {
  // the root divides, so that all agree whatever METIS does
  const std::vector<int32_t> rank =
      comm.gather_all(comm.root() ? assign_blocks(mesh, blocks, comm.size()) : std::vector<int32_t>{});
  find_border(mesh, blocks, rank);
  divide(mesh, blocks, rank);
  State all_nodes;  // what a state follows that isn't told otherwise
  follow_all(all_nodes);
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
  for (auto& chunks : b.colours)  // a chunk is one thread's, whosever its other blocks are
    std::erase_if(chunks, [&](const Chunk& chunk) {
      return std::none_of(rank.begin() + chunk.first, rank.begin() + chunk.last, [&](int32_t r) { return r == me; });
    });
}

void Ranks::find_border(const Mesh& mesh, Blocks& b, const std::vector<int32_t>& rank) {
  const int me = comm_.rank();
  const size_t ranks = size_t(comm_.size());
  const auto ranks_of = Csr<int32_t>::build(mesh.node_count(), [&](auto&& add) {  // each rank as often as it likes
    for (int e = 0; e < mesh.elem_count(); ++e)
      for (const NodeId n : mesh.hex[ElemId(e)]) add(n, rank[size_t(b.slot[ElemId(e)] / lanes)]);
  });
  home_.assign(size_t(mesh.node_count()), 0), is_mine_.assign(home_.size(), 0);
  std::vector<int32_t> number(home_.size(), -1);  // of this rank's border nodes
  int32_t count = 0;
  std::vector<std::vector<int32_t>> touching(home_.size());  // of border nodes: their ranks, each once
  for (size_t n = 0; n < home_.size(); ++n) {
    std::vector<int32_t> all(ranks_of[int64_t(n)].begin(), ranks_of[int64_t(n)].end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (all.empty()) continue;  // a node of no element
    home_[n] = all[0];
    is_mine_[n] = std::binary_search(all.begin(), all.end(), me);
    if (all.size() == 1) continue;
    if (is_mine_[n]) number[n] = count++;
    touching[n] = std::move(all);
  }
  send_.resize(ranks);
  std::vector<int32_t> received(ranks, 0);
  b.border.row.assign(size_t(b.block_count()), -1);
  std::vector<std::pair<int32_t, Addend>> found;  // at this rank's border nodes, in the order of one rank
  int32_t own = 0;
  const auto look_at = [&](int block, int a, int l) {
    const int32_t corner = (block * 8 + a) * lanes + l, r = rank[size_t(block)];
    const size_t n = size_t(b.node[size_t(corner)]);
    if (number[n] < 0) return;
    if (r != me) {
      found.push_back({number[n], {corner, r, received[size_t(r)]++}});
      return;
    }
    for (const int32_t other : touching[n])
      if (other != me) send_[size_t(other)].push_back(own);
    int32_t& row = b.border.row[size_t(block)];
    if (row < 0) {
      row = int32_t(b.border.place.size()) / (8 * lanes);
      b.border.place.resize(b.border.place.size() + 8 * lanes, -1);
    }
    b.border.place[size_t((row * 8 + a) * lanes + l)] = own;
    found.push_back({number[n], {corner, r, own++}});
  };
  for (const auto& chunks : b.colours)
    for (const Chunk& chunk : chunks)
      for (int block = chunk.first; block < chunk.last; ++block)
        for_corners(b.used[size_t(block)], [&](int a, int l) { look_at(block, a, l); });
  addends_ = Csr<Addend>::build(count, [&](auto&& add) {
    for (const auto& [row, addend] : found) add(row, addend);
  });
  const auto make_room = [&](auto& buffer, size_t width) {
    buffer.mine.resize(size_t(own));
    buffer.out.resize(ranks), buffer.in.resize(ranks);
    for (size_t r = 0; r < ranks; ++r)
      buffer.out[r].resize(width * send_[r].size()), buffer.in[r].resize(width * size_t(received[r]));
  };
  make_room(vectors_, 3), make_room(numbers_, 1);
  b.border.vectors = vectors_.mine.data(), b.border.numbers = numbers_.mine.data();
}

std::string Ranks::shares() const {
  std::string counts;
  for (const auto& list : elements_) counts += fmt::format("{}{}", counts.empty() ? "" : " + ", list.size());
  return fmt::format("{} ranks ({} elements, {} nodes of the first at a border) of ", comm_.size(), counts,
                     addends_.rows());
}

template <class T>
void Ranks::add_border(const Blocks& blocks, Buffer<T>& buffer, Field<T, NodeId>& a) {
  const Timed timed("exchange");
  constexpr size_t width = sizeof(T) / sizeof(double);
  const auto at = [](std::vector<double>& part, size_t i) -> T& { return reinterpret_cast<T*>(part.data())[i]; };
  for (size_t r = 0; r < send_.size(); ++r)
    for (size_t i = 0; i < send_[r].size(); ++i) at(buffer.out[r], i) = buffer.mine[size_t(send_[r][i])];
  static_assert(sizeof(T) == width * sizeof(double));
  comm_.exchange(buffer.out, buffer.in);
  parallel_for(addends_.rows(), [&](int64_t row) {
    for (const Addend& x : addends_[row])
      a[NodeId(blocks.node[size_t(x.corner)])] +=
          x.rank == comm_.rank() ? buffer.mine[size_t(x.place)] : at(buffer.in[size_t(x.rank)], size_t(x.place));
  });
  std::fill(buffer.mine.begin(), buffer.mine.end(), T{});  // a block that is left out next time adds nothing
}

void Ranks::sum(const Blocks& blocks, Field<double, NodeId>& a) { add_border(blocks, numbers_, a); }

void Ranks::sum(const Blocks& blocks, Field<Vec3, NodeId>& f) {
  add_border(blocks, vectors_, f);
  complete(everywhere_, &f.data()->x, 3);
}

void Ranks::complete(State& s) const {
  for (auto* field : {&s.x, &s.v, &s.f}) complete(elsewhere_, &field->data()->x, 3);
}

void Ranks::complete_positions(const Mesh& mesh, const std::vector<char>& is_asked, State& s) const {
  std::vector<char> is_wanted(home_.size(), 0);
  for (int e = 0; e < mesh.elem_count(); ++e)
    if (is_asked[size_t(e)])
      for (const NodeId n : mesh.hex[ElemId(e)]) is_wanted[size_t(n)] = !is_everywhere_[size_t(n)];
  Lists wanted(elements_.size());
  for (size_t n = 0; n < home_.size(); ++n)
    if (is_wanted[n]) wanted[size_t(home_[n])].push_back(int32_t(n));
  complete(wanted, &s.x.data()->x, 3);
}

void Ranks::follow(const std::vector<char>& is_needed_everywhere, State& s) {
  is_everywhere_ = is_needed_everywhere;
  everywhere_.assign(elements_.size(), {}), elsewhere_.assign(elements_.size(), {});
  s.followed.clear();
  for (size_t n = 0; n < home_.size(); ++n) {
    (is_everywhere_[n] ? everywhere_ : elsewhere_)[size_t(home_[n])].push_back(int32_t(n));
    if (is_mine_[n] || is_everywhere_[n]) s.followed.push_back(int32_t(n));
  }
}

void Ranks::follow_also(const std::vector<char>& is_needed_everywhere, State& s) {
  std::vector<char> all = is_everywhere_;
  for (size_t n = 0; n < all.size(); ++n) all[n] |= is_needed_everywhere[n];
  follow(all, s);
}

void Ranks::append_copies(std::span<const NodeSplit> splits, State& s) {
  for (const NodeSplit& split : splits) {  // a child of a border node may be one rank's alone: no harm
    const size_t p = size_t(split.parent);
    home_.push_back(home_[p]), is_mine_.push_back(is_mine_[p]), is_everywhere_.push_back(is_everywhere_[p]);
    (is_everywhere_[p] ? everywhere_ : elsewhere_)[size_t(home_[p])].push_back(split.child);
    if (is_mine_[p] || is_everywhere_[p]) s.followed.push_back(split.child);
  }
}

void Ranks::complete(const Lists& lists, double* values, size_t width) const {
  const Timed timed("exchange");
  std::vector<int> start{0};
  for (const auto& list : lists) start.push_back(start.back() + int(list.size() * width));
  if (start.back() == 0) return;
  std::vector<double> all(size_t(start.back()));
  const auto place = [&](size_t r, size_t i) { return all.data() + size_t(start[r]) + i * width; };
  const size_t me = size_t(comm_.rank());
  for (size_t i = 0; i < lists[me].size(); ++i) std::copy_n(values + size_t(lists[me][i]) * width, width, place(me, i));
  comm_.complete(all, start);
  for (size_t r = 0; r < lists.size(); ++r)
    for (size_t i = 0; r != me && i < lists[r].size(); ++i)
      std::copy_n(place(r, i), width, values + size_t(lists[r][i]) * width);
}

}  // namespace bw::csd
