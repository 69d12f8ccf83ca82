// SPDX-License-Identifier: Apache-2.0
// Warns when energy goes missing, ends the run when too much does, and says where it arises.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "csd/model.h"

namespace bw::csd {

/// What elements lost in a few steps: the change of what they store and spend less the work that their forces did, node
/// by node, at the mean force of each step. Central differences account for everything else exactly, but for filter,
/// viscosity and changes of topology, which appear as the rest.
class EnergyAudit {
 public:
  explicit EnergyAudit(const Model& m);
  /// After each step.
  void add(const Model& m);
  int steps() const { return steps_; }
  /// For the log: shares of the bodies, worst element, rest.
  std::string report(const Model& m);

 private:
  void look(const Model& m, bool first);
  double residual_;  // J, at the start of the audit
  int steps_ = 0;
  Field<Vec3, NodeId> x_;
  std::vector<Corners<double>> f_;        // [element] N, at x_
  std::vector<double> stored_, missing_;  // [element] J
};

class EnergyWatch {
 public:
  explicit EnergyWatch(const EnergyCase& cs) : case_(cs) {}
  /// A row of energies at the model's time. PhysicsError beyond `stop`.
  void check(const EnergyRow& row, Model& m);
  /// After each step; costs nothing unless an audit is under way.
  void tick(const Model& m);
  bool is_auditing() const { return audit_.has_value(); }
  /// |residual| over the energy at hand (the most that was there so far): at the last check, the largest so far. 0
  /// while there is none to speak of, no more than round-off makes of the elements' stiffness.
  double part() const { return part_; }
  double worst() const { return worst_; }
  /// In a checkpoint; an audit under way is given up.
  template <class A>
  void keep(A& a) {
    double round_off = round_off_.value_or(-1);
    a.value("scale", scale_), a.value("part", part_), a.value("worst", worst_), a.value("warned", warned_);
    a.value("round_off", round_off);
    if (round_off >= 0) round_off_ = round_off;
  }

 private:
  static constexpr int audit_steps = 50;
  EnergyCase case_;
  double scale_ = 0, part_ = 0, worst_ = 0;
  std::optional<double> round_off_;  // J
  bool warned_ = false;
  std::optional<EnergyAudit> audit_;
};

}  // namespace bw::csd
