// SPDX-License-Identifier: Apache-2.0
// To the static solution by dynamic relaxation: drag in proportion to mass, as strong as damps the slowest motion that
// is present critically [P. Underwood, Dynamic relaxation, in: Belytschko, Hughes (eds.), Computational Methods for
// Transient Analysis, 1983]. Its frequency is Rayleigh's quotient of the velocities, omega^2 = -sum v . df/dt / sum m
// v^2.
#pragma once
#include "common/parallel/loop.h"
#include "csd/load/conditions/damping.h"

namespace bw::csd {

/// [solid.static]
struct RelaxationCase {
  double tolerance = 1e-6, rate = 0, loads_until = 0;
  template <class K>
  void describe(K& k) {
    k.optional(
        "tolerance", tolerance, dim::none,
        "the run ends when the forces out of balance are less than this fraction of the loads and reactions, and "
        "the kinetic energy less than this fraction of the stored one (roots of sums of squares)");
    k.optional("rate", rate, dim::frequency,
               "of the drag, acceleration -rate v; 0: twice the frequency of the slowest motion that is seen");
    k.optional("loads_until", loads_until, dim::time, "when the loads are complete: no earlier end");
    k.expect(tolerance > 0, "tolerance", "a positive number");
    k.expect(rate >= 0, "rate", "a number >= 0 per time");
  }
};

class Relaxation {
 public:
  Relaxation(const RelaxationCase& cs, size_t nodes) : case_(cs), f_(nodes) { select(nodes); }

  /// After cracks.
  void select(size_t nodes) {
    std::vector<NodeId> all;
    for (size_t n = 0; n < nodes; ++n) all.push_back(NodeId(int64_t(n)));
    reaction.renew(all, nodes);
    f_.resize(nodes);
  }
  /// Last of all: s.f are the forces that conditions leave at the step's end, s.v the velocities of the step.
  void on_force(State& s, double dt) {
    if (dt > 0 && case_.rate == 0) follow(s, dt);
    out_of_balance_ = parallel_sum(int64_t(f_.size()), [&](int64_t i) { return dot(s.f[NodeId(i)], s.f[NodeId(i)]); });
    f_ = s.f;
    for (size_t i = 0; i < reaction.nodes.size(); ++i) {
      const NodeId n{int32_t(i)};
      if (s.m[n] > 0) reaction.take_force(s, i, -damping_force(s, n, rate(), dt), dt);
    }
  }
  double rate() const { return case_.rate > 0 ? case_.rate : 2 * std::sqrt(omega2_); }  ///< 1/s
  /// N^2, of the last step: sum over the nodes of the force squared that neither conditions nor drag hold.
  double out_of_balance() const { return out_of_balance_; }
  const RelaxationCase& input() const { return case_; }
  Reaction reaction;
  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    reaction.keep(a);
    a.list("force", f_);
    a.value("stiffness", stiffness_), a.value("mass", mass_), a.value("omega2", omega2_);
    a.value("out_of_balance", out_of_balance_);
  }

 private:
  /// Both sums of the quotient fade over a hundred steps, so that one quiet moment does not count as rest.
  void follow(const State& s, double dt) {
    struct Sums {
      double stiffness = 0, mass = 0;
    };
    const Sums now = parallel_reduce(
        int64_t(f_.size()), Sums{},
        [&](int64_t i) {
          const NodeId n(i);
          return Sums{dot(s.v[n], f_[n] - s.f[n]) / dt, s.m[n] * dot(s.v[n], s.v[n])};
        },
        [](const Sums& a, const Sums& b) {
          return Sums{a.stiffness + b.stiffness, a.mass + b.mass};
        });
    stiffness_ += 0.01 * (now.stiffness - stiffness_), mass_ += 0.01 * (now.mass - mass_);
    omega2_ = mass_ > 0 ? std::fmax(stiffness_ / mass_, 0) : 0;
  }
  RelaxationCase case_;
  Field<Vec3, NodeId> f_;  // N, of the last step, before the drag
  double stiffness_ = 0, mass_ = 0, omega2_ = 0, out_of_balance_ = 0;
};

}  // namespace bw::csd
