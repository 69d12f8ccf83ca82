// SPDX-License-Identifier: Apache-2.0
// The stable time step of the whole model, and who limits it.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "csd/element/elements.h"

namespace bw::csd {

/// omega_max^2 <= max over elements of lambda_max(K_e, M_e) for any share-out of the nodes' masses with sum M_e = M.
/// The own shares are one; each refresh moves mass, at every node, to the elements in proportion to omega_e^2 m_e, so
/// that stiff elements borrow from soft neighbours and the bound comes down to what the assembled model allows. The
/// bound of element/stable_step.h costs about as much as four forces, so it is evaluated every `refresh_steps`, or less
/// often while it hardly changes; in between each element's is scaled by its centroid part, which follows all of its
/// change of size and shape but distortion.
/// With local steps (csd/local_steps.h) omega_e is an element's frequency times its steps over the shortest, and masses
/// stay as they are: who lends could not take longer steps.
/// Elements with a collapsed point (q1p0.h) are evaluated in every step. Once the masses have settled, three of four
/// refreshes leave them as they are and pass over blocks far from limiting the step.
class TimeStep {
 public:
  /// s; infinite if all elements are rigid. Needs the results of internal_force at s.x. With local steps it is a whole
  /// step, as long as the levels allow.
  double stable(const Elements& elements, const State& s);
  /// Of the last call. Ties: lowest slot.
  SlotId limiting() const { return limiting_; }
  /// Whether the last call evaluated bounds anew.
  bool refreshed() const { return refreshed_; }
  /// Bound of an element's own frequency squared at the last call, with its share of the nodes' masses [1/s^2].
  double omega2(const State& s, SlotId slot) const;
  /// The lowest slot whose volume isn't positive (or not a number) in the last call.
  std::optional<SlotId> inverted() const { return inverted_; }

  /// An element's present share of its nodes' masses over its own mass.
  double borrowed(const Elements& elements, ElemId e, const std::array<double, 8>& own) const;
  /// An own element has become heavier by `more` at its corners: its share grows by it.
  void make_heavier(const Elements& elements, ElemId e, const std::array<double, 8>& more);
  /// Every element has its own mass again, and the bound of it: what lending began with. From there on no bound rises
  /// above the largest.
  void lend_nothing(const Mesh& mesh, const Elements& elements, const State& s);

  /// The topology or the masses have changed.
  void renew() { stale_ = true; }
  /// These nodes were split by cracks, and have their new masses: the elements around get their own part of them there,
  /// as at first, and bounds of their own are evaluated. The rest stays.
  void renew(const Mesh& mesh, const Topology& topology, const Elements& elements, const State& s,
             std::span<const NodeId> nodes);
  static constexpr int refresh_steps = 24, most_steps = 192;
  static constexpr double calm = 0.005;  ///< relative change from refresh to refresh, of the worst omega^2 since
  static constexpr int settling = 8, whole_refresh = 4;  ///< refreshes: of all at first; then of all once in
  static constexpr double stiff_part = 0.25;             ///< of the largest omega^2: others are passed over

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.blocks("mass", mass_, 8 * lanes);
    a.blocks("distortion", distortion_, lanes, 1.0f);
    a.value("refreshed_at", refreshed_at_), a.value("refreshes", refreshes_), a.value("interval", interval_);
    a.value("refreshed_omega2", refreshed_omega2_), a.value("omega2", omega2_), a.value("stale", stale_);
    a.value("limiting", limiting_);
  }

 private:
  void set_corner(const Elements& elements, SlotId slot, int a, double mass);
  void share_masses(const Elements& elements, const State& s);
  enum class Which { all, stiff, collapsed };                             // all: with new shares of mass
  double refresh(const Elements& elements, const State& s, Which which);  // the largest relative change
  void refresh_all(const Elements& elements, const State& s);
  Aligned<float> mass_;              // [block][8][lanes] kg, M_e
  Field<float, SlotId> distortion_;  // bound / centroid part
  int64_t refreshed_at_ = 0, refreshes_ = 0;
  int interval_ = refresh_steps;
  double refreshed_omega2_ = 0;  // at the last refresh
  double omega2_ = 0;            // of the last call
  bool stale_ = true, refreshed_ = false;
  SlotId limiting_;
  std::optional<SlotId> inverted_;
};

}  // namespace bw::csd
