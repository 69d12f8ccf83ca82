// SPDX-License-Identifier: Apache-2.0
// Which elements break, and in which order their faces open.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/data/field.h"
#include "common/math/tensor.h"
#include "csd/fracture/list.h"
#include "csd/fracture/pieces.h"
#include "csd/fracture/scatter.h"
#include "csd/mesh/topology.h"

namespace bw::csd {

/// [solid.fracture]
struct FractureInput {
  struct CriterionTable {
    Criteria model = EqpsLimit{};
    template <class K>
    void describe(K& k) {
      k.pick("kind", model, "when an element is broken", true);
    }
  } criterion;
  std::optional<PiecesInput> pieces;
  std::optional<Scatter> scatter;
  bool is_smoothed = true, is_weighted = true, skip_safe = true;
  std::string place;
  int faces_per_element = 6;
  template <class K>
  void describe(K& k) {
    k.table("criterion", criterion, "failure value of an element; 1 or more is broken");
    k.table("pieces", pieces,
            "break-up of rings about an axis into pieces of a size that statistics give, eq (17); absent: node "
            "disconnection alone, eq (16)");
    k.table("scatter", scatter, "random strength of each element, after Weibull; absent: all are alike");
    k.optional("skip_safe", skip_safe,
               "elements that can't be near failure are passed over: not reached yet, or too little stressed for what "
               "the criterion asks (faster; the same results)");
    k.optional("smoothing", is_smoothed, "select by the mean over an element's nodes of the mean over their elements");
    k.optional("weighted", is_weighted, "that nodal mean weights elements by volume; false: plain mean");
    k.optional(
        "faces_per_element", faces_per_element,
        "faces that a broken element may open in all, one in a step; 6: no limit, which in the end parts all broken "
        "elements; fewer leave larger pieces");
    if (!k.is_manual()) place = k.where("criterion");
    k.expect(faces_per_element >= 1 && faces_per_element <= 6, "faces_per_element", "1 to 6");
  }
};

class Fracture {
 public:
  Fracture(const FractureInput& input, const Mesh& mesh);

  /// Whether an element must not be looked at; empty: none.
  using Holds = std::function<bool(ElemId)>;

  /// Elements whose selection is at least 1, the largest first (ties: lowest elem_gid), but those that are held.
  std::vector<ElemId> broken(const Mesh& mesh, const Topology& topology, std::span<const double> fail,
                             const Holds& holds);

  /// One step: broken elements, the worst first (ties: lowest elem_gid), open one face each, eq (16). Failure values
  /// are taken anew around every opened face, for its nodes now average over fewer elements. An element without a
  /// joined face in tension waits. x: current positions [m] of the nodes (a younger one lies where its parent does);
  /// sigma: mean Cauchy stress [Pa] of an element, asked for broken elements only, by several threads at once; fail:
  /// failure value of each element. Mesh and topology are changed; appends to splits in order, to be passed to
  /// State::append_copies, and to changed the elements with new nodes, which then is ascending without repetitions.
  /// Returns true if there are any. The same for any number of threads.
  bool advance(Mesh& mesh, Topology& topology, std::span<const Vec3> x, const std::function<Sym3(ElemId)>& sigma,
               std::span<const double> fail, std::vector<NodeSplit>& splits, std::vector<ElemId>& changed,
               const Holds& holds = {});

  /// These never open again, and share no node with any that may.
  void retire(std::span<const ElemId> elems) {
    for (const ElemId e : elems) is_done_[e] = 1;
  }

  /// Failure value by which elements are selected: smoothed, or as given.
  double selection(const Mesh& mesh, const Topology& topology, std::span<const double> fail, ElemId e);

  int64_t opened() const { return opened_; }  ///< faces opened since the start
  int64_t waiting() const {
    return waiting_;
  }  ///< elements that were broken at the last step but had no joined face in tension

  /// In a checkpoint. What is known of one step alone is found anew in the next.
  template <class A>
  void keep(A& a) {
    a.list("opened_by", opened_by_), a.list("done", is_done_);
    a.value("opened", opened_), a.value("waiting", waiting_);
  }

 private:
  double average(const Topology& topology, std::span<const double> fail, NodeId n) const;
  void average_nodes(const Mesh& mesh, const Topology& topology, std::span<const double> fail,
                     std::span<const ElemId> elems);
  double nodal(const Topology& topology, std::span<const double> fail, NodeId n);
  void forget(NodeId n);
  void begin_step(const Mesh& mesh);
  std::vector<ElemId> broken_elements(const Mesh& mesh, const Topology& topology, std::span<const double> fail,
                                      const Holds& holds);

  FractureInput input_;
  Field<double, ElemId> weight_;
  Field<int8_t, ElemId> opened_by_;  // faces that an element has opened
  Field<char, ElemId> is_done_;      // retired, or shares no node: nothing can open any more
  // of the present step: nodal means that are known, nodes near what has failed, elements seen or done
  int64_t step_ = 0;
  Field<double, NodeId> mean_;
  Field<int64_t, NodeId> mean_step_, near_step_;
  Field<int64_t, ElemId> seen_step_, done_step_;
  int64_t opened_ = 0, waiting_ = 0;
};

}  // namespace bw::csd
