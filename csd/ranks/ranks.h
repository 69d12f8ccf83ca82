// SPDX-License-Identifier: Apache-2.0
// csd on several ranks. Every rank knows the whole mesh and makes the same cracks; it computes the elements of its own
// blocks only, and their history is nowhere else. Nodal fields have their full length on every rank, but a rank follows
// only the nodes of its own elements, and those that the model needs everywhere (loads, conditions: follow()); the
// others are brought up to date on request (complete()).
//
// Bit-equal to one rank: a node of one rank's elements alone is summed there, as ever. At the others, the border nodes,
// each element's addend travels, and the ranks that touch the node add them all in the order in which one rank adds.
// Which nodes are border nodes is found out once, from the uncracked mesh: cracks only remove sharing, and a child is
// what its parent was.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/data/csr.h"
#include "common/parallel/mpi.h"
#include "csd/element/blocks.h"
#include "csd/mesh/topology.h"

namespace bw::csd {

struct State;

class Ranks {
 public:
  /// Divides the blocks among the ranks of comm: `blocks` becomes this rank's. All nodes are followed. Collective, as
  /// everything here.
  Ranks(const Comm& comm, const Mesh& mesh, Blocks& blocks);

  const Comm& comm() const { return comm_; }
  /// For the log: "2 ranks (7680 + 7680 elements, 289 nodes between them) of ".
  std::string shares() const;

  // --- in each step
  /// From the sums over this rank's elements (for_coloured_blocks) to those over all, at the nodes of its own elements.
  void sum(const Blocks& blocks, Field<double, NodeId>& a);
  /// The same at all nodes that it follows.
  void sum(const Blocks& blocks, Field<Vec3, NodeId>& f);

  // --- on request
  /// x, v, f at all nodes.
  void complete(State& s) const;
  /// x at the nodes of these elements, which are the same on all ranks.
  void complete_positions(const Mesh& mesh, const std::vector<char>& is_asked, State& s) const;
  /// [element] own elements' values are here, all are afterwards. T holds doubles.
  template <class T>
  void complete(std::vector<T>& of_elements) const {
    complete(elements_, reinterpret_cast<double*>(of_elements.data()), sizeof(T) / sizeof(double));
  }
  /// value(e) of the elements that are asked for, from their owners; the others' are T{}. is_asked [element] is the
  /// same on all ranks.
  template <class T, class Value>
  std::vector<T> complete_some(const std::vector<char>& is_asked, const Value& value) const;
  /// [block] likewise.
  template <class T>
  void complete_blocks(std::vector<T>& of_blocks) const {
    complete(blocks_, reinterpret_cast<double*>(of_blocks.data()), sizeof(T) / sizeof(double));
  }
  /// The value that the owner of an element has.
  template <class T>
  T from_owner(const Blocks& blocks, ElemId e, const T& value) const {
    return comm_.gather_all(blocks.is_own(e) ? std::vector{value} : std::vector<T>{})[0];
  }

  // --- nodes
  /// From now on s follows this rank's nodes and those marked [node], which are the same on all ranks; s is complete.
  void follow(const std::vector<char>& is_needed_everywhere, State& s);
  /// Those marked too, from now on; s is complete at them.
  void follow_also(const std::vector<char>& is_needed_everywhere, State& s);
  void follow_all(State& s) { follow(std::vector<char>(home_.size(), 1), s); }
  /// Nodes were split.
  void append_copies(std::span<const NodeSplit> splits, State& s);

 private:
  using Lists = std::vector<std::vector<int32_t>>;  // [rank]
  struct Addend {                                   // at a corner of a border node
    int32_t corner;                                 // index into Blocks::node
    int32_t rank, place;                            // whose; among this rank's own, or among those received
  };
  template <class T>
  struct Buffer {
    std::vector<T> mine;                       // addends at border nodes, filled by loops over blocks
    std::vector<std::vector<double>> out, in;  // [rank]
  };

  void divide(const Mesh& mesh, Blocks& blocks, const std::vector<int32_t>& rank);
  void find_border(const Mesh& mesh, Blocks& blocks, const std::vector<int32_t>& rank);
  void complete(const Lists& lists, double* values, size_t width) const;
  template <class T>
  void add_border(const Blocks& blocks, Buffer<T>& buffer, Field<T, NodeId>& a);

  Comm comm_;
  Lists elements_, blocks_;
  std::vector<int32_t> home_;                  // [node] the lowest rank that has an element of it
  std::vector<char> is_mine_, is_everywhere_;  // [node] this rank has an element of it; all ranks follow it
  Lists everywhere_, elsewhere_;               // nodes, by home: that all ranks follow, or not
  Lists send_;                                 // own addends for each rank
  Csr<Addend> addends_;                        // [border node of this rank] in the order of one rank
  Buffer<Vec3> vectors_;
  Buffer<double> numbers_;
};

template <class T, class Value>
std::vector<T> Ranks::complete_some(const std::vector<char>& is_asked, const Value& value) const {
  Lists asked(elements_.size());
  for (size_t r = 0; r < asked.size(); ++r)
    for (const int32_t e : elements_[r])
      if (is_asked[size_t(e)]) asked[r].push_back(e);
  const auto& mine = asked[size_t(comm_.rank())];
  std::vector<T> values(is_asked.size());
  parallel_for(int64_t(mine.size()),
               [&](int64_t i) { values[size_t(mine[size_t(i)])] = value(ElemId(mine[size_t(i)])); });
  complete(asked, reinterpret_cast<double*>(values.data()), sizeof(T) / sizeof(double));
  return values;
}

}  // namespace bw::csd
