// SPDX-License-Identifier: Apache-2.0
// Cracks and fragments in the step: failure values from the elements, then everything that a split node touches. A
// crack changes mass, momentum and energy by nothing but the filter's share, which is booked: nodes get their parent's
// position, velocity and acceleration.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "csd/fracture/failure.h"
#include "csd/fracture/fracture.h"
#include "csd/fragments/fragments.h"

namespace bw::csd {

struct Model;

class Cracks {
 public:
  /// materials [body]: what is known of their failure.
  Cracks(const FractureInput& input, const Mesh& mesh, double t, const std::vector<FailureData>& materials = {});

  /// Opens what breaks at the model's time. Returns true if the topology changed.
  bool advance(Model& model);
  /// Failure value of each element at the last step, before smoothing; of several ranks' only the own ones are sure.
  const std::vector<double>& fail() const { return failure_.values(); }
  /// Elements whose stress the criterion has looked at so far on this rank.
  int64_t examined() const { return failure_.examined(); }
  /// Up to date with all cracks; those that broke off since the last call are born now.
  const Fragments& fragments(const Model& model);
  int64_t opened_faces() const { return fracture_.opened() + opened_by_pieces_; }
  /// The rings that broke up into pieces; null: the case has none.
  const Pieces* pieces() const { return pieces_ ? &*pieces_ : nullptr; }

  /// Opens the model's cracks again, up to the connectivity and the parents of nodes that a checkpoint has: the mesh
  /// and all that follows it grow; numbers are left to be restored.
  void repeat(Model& model, std::span<const std::array<NodeId, 8>> hex, std::span<const NodeId> parent);
  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    failure_.keep(a);
    fracture_.keep(a);
    if (pieces_) {
      A section = a.section("pieces");
      pieces_->keep(section);
    }
    fragments_.keep(a);
    a.value("opened_by_pieces", opened_by_pieces_), a.value("warned", warned_), a.value("relabelled", relabelled_);
  }

 private:
  bool update_failure(const Model& model);
  std::vector<char> near_broken(const Model& model) const;
  void make_pieces(Model& model);
  std::vector<RingSample> ring_samples(const Model& model, std::span<const ElemId> elems) const;
  void grow(Model& model, const std::vector<NodeSplit>& splits, const std::vector<ElemId>& changed);
  void take_over(Model& model, const std::vector<NodeSplit>& splits, const std::vector<ElemId>& changed);

  Failure failure_;
  Fracture fracture_;
  std::optional<Pieces> pieces_;
  int64_t opened_by_pieces_ = 0;
  bool warned_ = false;
  Fragments fragments_;
  std::vector<NodeSplit> splits_;
  std::vector<ElemId> changed_;
  bool relabelled_ = true;
};

}  // namespace bw::csd
