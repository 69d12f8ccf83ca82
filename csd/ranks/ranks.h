// SPDX-License-Identifier: Apache-2.0
// csd on several ranks. Every rank knows the whole mesh, makes the same cracks, and holds all nodal fields; it computes
// the elements of its own blocks only, and their history is nowhere else.
//
// Bit-equal to one rank: a node of one rank's elements alone is summed there, as ever. Of the others, the border nodes,
// each element's addend travels, and all ranks add them in the order in which one rank adds. Which nodes are border
// nodes is found out once, from the uncracked mesh: cracks only remove sharing, and a child is what its parent was.
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

class Ranks {
 public:
  /// Divides the blocks among the ranks of comm: `blocks` becomes this rank's. Collective, as everything here.
  Ranks(const Comm& comm, const Mesh& mesh, Blocks& blocks);

  const Comm& comm() const { return comm_; }
  /// For the log: "2 ranks (7680 + 7680 elements, 289 nodes between them) of ".
  std::string shares() const;
  /// From the sums over this rank's elements (for_coloured_blocks) to those over all, on all ranks.
  void sum(const Blocks& blocks, Field<Vec3, NodeId>& f);
  void sum(const Blocks& blocks, Field<double, NodeId>& a);

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
  void complete_blocks(std::vector<double>& of_blocks) const { complete(blocks_, of_blocks.data(), 1); }
  /// The value that the owner of an element has.
  template <class T>
  T from_owner(const Blocks& blocks, ElemId e, const T& value) const {
    return comm_.gather_all(blocks.is_own(e) ? std::vector{value} : std::vector<T>{})[0];
  }

  /// Nodes were split.
  void append_copies(std::span<const NodeSplit> splits);

 private:
  using Lists = std::vector<std::vector<int32_t>>;  // [rank]
  struct Addend {                                   // at a corner of a border node
    int32_t corner;                                 // index into Blocks::node
    int32_t rank, place;                            // whose, and where in its part of a buffer
  };
  template <class T>
  struct Buffer {
    std::vector<T> mine;  // addends at border nodes, filled by loops over blocks
    std::vector<T> all;   // of each rank its addends, then its sums at inner nodes
  };

  void divide(const Mesh& mesh, Blocks& blocks, const std::vector<int32_t>& rank);
  void find_border(const Mesh& mesh, Blocks& blocks, const std::vector<int32_t>& rank);
  void complete(const Lists& lists, double* values, size_t width) const;
  template <class T>
  void sum(const Blocks& blocks, Buffer<T>& buffer, Field<T, NodeId>& a);

  Comm comm_;
  Lists elements_, blocks_, inner_;  // inner_: nodes of one rank's elements
  std::vector<int32_t> home_;        // [node] rank whose inner node it is; -1: none's
  std::vector<int> addends_of_;      // [rank] their number
  Csr<Addend> addends_;              // [border node of the uncracked mesh] in the order of one rank
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
