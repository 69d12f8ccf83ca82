// SPDX-License-Identifier: Apache-2.0
// Pressure filter against the volumetric checkerboard of Q1/P0 (VALIDATION A.4). A = mean over an element's nodes of
// the nodal V-weighted mean over elements: exact for constants, for linear fields inside; self-adjoint in the V inner
// product; never across a crack (its nodes are doubled). A_b = (1 - strength) + strength A.
//   plain         sigma_m = A_b U'(J)
//   self_adjoint  sigma_m = A_b U'(A_b J): the derivative of sum V U(A_b J), so energy and momentum stay exact
// Gated, with g = 0 or 1 per element: A_b J = J + strength g (A J - J), and its adjoint. A gate opens once and for all:
// one that also closes pumps energy into the checkerboard (soft while it is open, stiff again after), which grew to 18
// % of the volumes on the Taylor bar. Opening takes energy out, so the work of what the filter changes is booked, as
// for the plain one. The filter acts on the mean stress of the moment, never on a stored one: applied to a stored one
// it would be a diffusion.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "common/math/units.h"
#include "csd/element/elements.h"

namespace bw::csd {

struct FilterCase {
  std::string kind = "off";
  double strength = 0.5;
  std::string gate = "none";
  double threshold = 0.1;
  bool beyond = false;
  template <class K>
  void describe(K& k) {
    k.choice("kind", kind, {"off", "plain", "self_adjoint"},
             "plain: the mean stress is smoothed; self_adjoint: the volume ratio is smoothed and the stress follows "
             "from the "
             "energy, so that energy is conserved");
    k.optional("strength", strength, dim::none,
               "weight of the smoothed part, at most 0.5: beyond, checkerboard volumes lose their stiffness");
    k.choice(
        "gate", gate, {"none", "checkerboard", "plastic", "both"},
        "where the filter acts. none: everywhere; checkerboard: where the mean stress p has left its neighbours' mean "
        "Ap by more than `threshold` and to the other side than they did, so not in smooth fields and fronts; "
        "plastic: where the material has flowed; both: where both held in one step");
    k.optional("threshold", threshold, dim::none, "of |p - Ap| / (|Ap| + 1e-4 bulk modulus)");
    k.optional("beyond", beyond, "allows a strength up to 1, to see what it does");
    k.expect(strength > 0 && strength <= (beyond ? 1.0 : 0.5), "strength", "a number in (0, 0.5]");
    k.expect(threshold >= 0, "threshold", "a number >= 0");
  }
};

class PressureFilter {
 public:
  PressureFilter(const FilterCase& cs, const Elements& elements, const State& s);

  /// Mean stress for the forces at s.x [Pa]; valid until the next call.
  const Field<double, SlotId>& smooth(const Elements& elements, const State& s);
  /// The mean stress of the last smooth(), null before.
  const Field<double, SlotId>* mean_stress() const { return sigma_.size() ? &sigma_ : nullptr; }
  /// J: energy that the elements store beyond sum V U(J) (self_adjoint), or that smoothing took out since the start
  /// (plain).
  double energy(const Elements& elements, const State& s) const;
  /// After cracks: `touched` (ascending) are the nodes that were split and the new ones; s has its new length. Returns
  /// the energy that this set free [J]. The mean stress stays that of the last smooth(), but energy() is up to date.
  double open(const Mesh& mesh, const Topology& topology, const Elements& elements, const State& s,
              std::span<const NodeId> touched);

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.nodes("share", share_);
    if (a.restores()) sum_.resize(share_.size());
    for (auto [name, field] : {std::pair{"J", &J_},
                               {"theta", &theta_},
                               {"stress", &stress_},
                               {"sigma", &sigma_},
                               {"change", &change_},
                               {"volume", &volume_},
                               {"gate", &gate_},
                               {"eqps", &eqps_},
                               {"mean", &mean_},
                               {"rough", &rough_}})
      a.blocks(name, *field, lanes);
    a.value("work", work_);
  }

 private:
  void renew(const Elements& elements, const State& s);
  double open_locally(const Mesh& mesh, const Topology& topology, const Elements& elements, const State& s,
                      std::span<const NodeId> touched);
  void renew_gate(const Elements& elements, const State& s);
  void smooth_gated(const Elements& elements, const State& s);
  void mean(const Elements& elements, const State& s, const Field<double, SlotId>& a, Field<double, SlotId>& out);
  void average(const Elements& elements, const State& s, const Field<double, SlotId>& a, double strength,
               Field<double, SlotId>& out);
  void blend(const Elements& elements, const State& s, int block, int first, const Field<double, SlotId>& a,
             double strength, const Field<double, NodeId>& means, Field<double, SlotId>& out) const;
  void smooth_self_adjoint(const Elements& elements, const State& s);
  void book_work(const Elements& elements, const State& s);

  FilterCase case_;
  bool self_adjoint_;
  double strength_;
  bool skips_rigid_ = true;               // elements of rigid bodies keep their values
  Field<double, NodeId> share_;           // 1/m^3: an eighth over the volume of a node's elements
  Field<double, NodeId> sum_, next_sum_;  // work space
  Field<double, SlotId> addends_;         // work space
  Field<double, SlotId> J_, theta_, stress_, sigma_;
  Field<double, SlotId> change_, volume_;             // plain: sigma_m - U' and volume of the last call
  Field<double, SlotId> gate_, eqps_, mean_, rough_;  // gated: 1 once it is open; of the last step; work space
  double work_ = 0;                                   // J
  friend class Checkerboard;
};

/// Raw checkerboard indicator: sum V |p - A p| / sum V |p| with p = U'(J), J = State::volume / V0; 0 for a smooth field,
/// about 1 for a checkerboard.
class Checkerboard {
 public:
  double of(const Elements& elements, const State& s);

 private:
  std::optional<PressureFilter> whole_;  // A; its sums hold until nodes are split
};

}  // namespace bw::csd
