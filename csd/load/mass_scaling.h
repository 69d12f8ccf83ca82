// SPDX-License-Identifier: Apache-2.0
// Mass added to elements whose stable step is too short, no more than it takes, and booked.
#pragma once
#include "csd/element/time_step.h"

namespace bw::csd {

/// [solid.mass_scaling]
struct MassScalingCase {
  double minimum_step = 0, limit = 0.05;
  template <class K>
  void describe(K& k) {
    k.required("minimum_step", minimum_step, dim::time,
               "no step is shorter (with its safety): elements that would force one get more mass, at the start and "
               "later");
    k.optional("limit", limit, dim::none, "a run that would add more than this fraction of the whole mass ends");
    k.expect(minimum_step > 0, "minimum_step", "a positive time");
    k.expect(limit > 0, "limit", "a positive number");
  }
};

class MassScaling {
 public:
  MassScaling(const MassScalingCase& cs, const State& s);

  /// The stable step, made at least minimum_step / safety. PhysicsError beyond the limit. Elements whose own mass is
  /// enough get none, even if they have lent so much of it (time_step.h) that they limit the step now: they take it
  /// back.
  double enforce(const Mesh& mesh, Elements& elements, TimeStep& time_step, double safety, double stable, State& s);
  double added_mass() const { return added_; }            ///< kg, since before the start
  double added_energy() const { return energy_; }         ///< J, kinetic, that came with it since the start
  int64_t elements() const { return int64_t(heavier_); }  ///< how often an element got more

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.value("whole", whole_), a.value("added", added_), a.value("energy", energy_), a.value("heavier", heavier_);
  }

 private:
  void add(const Mesh& mesh, Elements& elements, TimeStep& time_step, ElemId e, double part, State& s);
  MassScalingCase case_;
  double whole_ = 0, added_ = 0, energy_ = 0;
  int64_t heavier_ = 0;
};

}  // namespace bw::csd
