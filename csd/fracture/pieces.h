// SPDX-License-Identifier: Apache-2.0
// Break-up into pieces of a size that statistics give (the paper's second option, eq (17)) in place of single elements.
// The seven steps, as VALIDATION C reads them:
//   1 the element with the largest failure value, not in a piece yet, at z* along the weapon's axis
//   2 width x0 of fragments there, eq (17), from the radius and radial speed of the ring around it
//   3 length of the rings to look at: l0 = 4 x0
//   4 their mean failure values: above the element [z*, z* + l0), below [z* - l0, z*)
//   5 a ring whose mean is at least 1 breaks up; the other waits
//   6 x0 from its own means, length l0 = 4 r x0, r uniform in [0.625, 1.25], thickness x0 / (4 r') on request
//   7 cuts: elements go into bins by angle and length, and the faces between bins open
#pragma once
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "common/io/keys.h"
#include "csd/fracture/bins.h"
#include "csd/fracture/size/list.h"
#include "csd/mesh/topology.h"

namespace bw::csd {

/// [solid.fracture.pieces]
struct PiecesInput {
  SizeLaws law = Mott{};
  Vec3 axis{0, 0, 1}, point{0, 0, 0};
  int seed = 1;
  double least_speed = 10, shortest = 2.5, longest = 5;
  bool layers = false;
  std::vector<std::string> exempt;
  std::vector<double> range;
  std::string place;
  template <class K>
  void describe(K& k) {
    k.pick("kind", law, "what gives the width x0 of pieces", true);
    k.optional("axis", axis, dim::none, "direction of the weapon's axis (of any length)");
    k.optional("point", point, dim::length, "a point of the axis");
    k.optional("seed", seed, "of the random lengths and angles");
    k.optional("least_speed", least_speed, dim::velocity,
               "rings that expand more slowly open by single elements, like the exempt parts");
    k.optional("shortest", shortest, dim::none, "least length of a piece over its width");
    k.optional("longest", longest, dim::none, "largest length over width; lengths are drawn uniformly between");
    k.optional(
        "layers", layers,
        "cut the wall into layers, x0 over a ratio drawn like the length's thick, where it is thicker than two of "
        "them and has the elements");
    k.optional("exempt", exempt, "element sets that open by single elements (nose and base plugs)");
    k.optional("range", range, dim::length,
               "two places along the axis, from `point`: only elements between them break up into pieces");
    k.expect(norm(axis) > 0, "axis", "a direction other than (0, 0, 0)");
    k.expect(least_speed > 0, "least_speed", "a positive speed");
    k.expect(shortest > 0, "shortest", "a positive number");
    k.expect(longest >= shortest, "longest", "a number not below `shortest`");
    k.expect(range.empty() || (range.size() == 2 && range[0] < range[1]), "range", "two ascending places");
    if (!k.is_manual()) place = k.where("exempt");
  }
};

/// What an element adds to the means of its ring; only doubles.
struct RingSample {
  double mass = 0, radius = 0, speed = 0, stress = 0, density = 0;
};

/// A ring that broke up.
struct Row {
  double t = 0;                 ///< s
  double lower = 0, upper = 0;  ///< m, first and last centroid along the axis, in the reference configuration
  RingState state;
  double width = 0;  ///< m, x0
  double ratio = 0;  ///< length over width as drawn; the last row of a gap takes what is left too
  int32_t body = 0, first_bin = 0, bins = 0, elements = 0;
  int around = 1, layers = 1;
  double across = 0;  ///< elements that x0 spans
};

class Pieces {
 public:
  /// InputError if the mesh has no element set of a given name.
  Pieces(const PiecesInput& input, const Mesh& mesh);

  /// Samples of elements in their order, the same on all ranks.
  using Sampler = std::function<std::vector<RingSample>(std::span<const ElemId>)>;

  /// Steps 1 to 7 at time t [s]. broken: elements and their failure values (selection), the worst first; fail
  /// [element]. Appends to splits and changed, as cut_between does, and to taken the elements that are in pieces now.
  /// Elements of fragments that don't break any more stay out of the bins. Returns the number of faces opened.
  using IsWhole = std::function<bool(ElemId)>;
  int64_t advance(
      Mesh& mesh, Topology& topology, double t, std::span<const ElemId> broken, std::span<const double> fail,
      const Sampler& sample, std::vector<NodeSplit>& splits, std::vector<ElemId>& changed, std::vector<ElemId>& taken,
      const IsWhole& is_whole = [](ElemId) { return false; });

  /// Whether the element is not in a piece but may come into one.
  bool is_free(ElemId e) const { return place_[e] >= 0 && bin_[e] < 0; }
  /// Whether the element must not open by itself: it is in a piece, or its ring waits. Valid after advance().
  bool holds(ElemId e) const { return bin_[e] >= 0 || (place_[e] >= 0 && let_go_[e] != step_); }
  const AxisFrame& frame() const { return frame_; }
  /// Bin of each element, the same for a whole piece; -1: none.
  const Field<int32_t, ElemId>& bins() const { return bin_; }
  const std::vector<Row>& rows() const { return rows_; }
  const PiecesInput& input() const { return input_; }

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    std::vector<int32_t> edges(edges_.begin(), edges_.end());
    a.list("bin", bin_), a.list("seen", seen_), a.list("let_go", let_go_), a.list("edges", edges),
        a.list("rows", rows_);
    a.value("step", step_), a.value("bins", bin_count_);
    edges_.clear(), edges_.insert(edges.begin(), edges.end());
  }

 private:
  struct Range {  // of places
    int32_t first = 0, last = 0;
    int32_t size() const { return last - first; }
  };
  RingState ring_state(Range range, const Sampler& sample) const;
  double mean_fail(Range range, std::span<const double> fail) const;
  Range gap_around(int32_t place) const;
  Range between(Range gap, double lower, double upper) const;
  void mark(Range range, Field<int32_t, ElemId>& step);
  int64_t examine(Mesh& mesh, Topology& topology, double t, ElemId worst, std::span<const double> fail,
                  const Sampler& sample, std::vector<NodeSplit>& splits, std::vector<ElemId>& changed,
                  std::vector<ElemId>& taken, const IsWhole& is_whole);
  std::vector<ElemId> make_row(const Mesh& mesh, const Topology& topology, double t, ElemId worst, Range gap,
                               double start, bool is_top, const RingState& state, const IsWhole& is_whole);

  PiecesInput input_;
  AxisFrame frame_;
  Field<double, ElemId> volume_;          // reference
  std::vector<ElemId> order_;             // elements that may come into pieces by body, place along the axis, gid
  std::vector<double> z_;                 // [place] centroid along the axis, reference
  Field<int32_t, ElemId> place_;          // in order_; -1: exempt
  Field<int32_t, ElemId> bin_;            // -1: none
  Field<int32_t, ElemId> seen_, let_go_;  // step of
  std::set<int32_t> edges_;               // places where bodies, rows and gaps between rows begin and end
  int32_t step_ = 0, bin_count_ = 0;
  std::vector<Row> rows_;
};

/// Replaces the file: one line a row. std::runtime_error if it can't be written.
void write_rows(const std::string& path, std::span<const Row> rows);

}  // namespace bw::csd
