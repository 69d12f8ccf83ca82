// SPDX-License-Identifier: Apache-2.0
// The stable time step of the whole model, and who limits it.
#pragma once
#include <optional>

#include "csd/element/elements.h"

namespace bw::csd {

/// 2/omega_max of the worst element bounds the model's step (Irons). The bound of element/stable_step.h costs about as much as
/// a force, so it is evaluated every `refresh_steps`; in between each element's is scaled by its centroid part, which
/// follows all of its change of size and shape but distortion.
class TimeStep {
 public:
  TimeStep(const Mesh& mesh, const Elements& elements);
  /// s. Needs the results of internal_force at s.x.
  double stable(const Elements& elements, const State& s);
  /// Of the last call. Ties: lowest slot.
  SlotId limiting() const { return limiting_; }
  /// The lowest slot whose volume isn't positive (or not a number) in the last call.
  std::optional<SlotId> inverted() const { return inverted_; }

  static constexpr int refresh_steps = 16;

 private:
  void refresh(const Elements& elements, const State& s);
  Aligned<double> mass_;                // [block][8][lanes] kg, an element's own share at its nodes
  Field<double, SlotId> distortion_;    // bound / centroid part
  int64_t refreshed_at_ = -refresh_steps;
  SlotId limiting_;
  std::optional<SlotId> inverted_;
};

}  // namespace bw::csd
