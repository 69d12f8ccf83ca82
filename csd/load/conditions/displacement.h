// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "csd/load/conditions/reaction.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

/// Nodes whose displacement along a direction follows a table; across it they are free (or held). Each step ends
/// exactly on the table.
struct PrescribedDisplacement {
  static constexpr auto name = "displacement";
  std::string nodes, across = "free", place;
  Vec3 direction{};
  Table table;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set");
    k.required("direction", direction, dim::none, "of the displacement (of any length)");
    table.describe_with(k, "displacements", dim::length,
                        "along `direction`, from the place at the start; linear between, constant outside");
    k.choice("across", across, {"free", "held"}, "what the nodes do perpendicular to `direction`");
    k.expect(norm(direction) > 0, "direction", "a direction other than (0, 0, 0)");
    if (!k.is_manual()) place = k.where("nodes"), direction = unit(direction);
  }
  void select(const Mesh& mesh) {
    reaction.renew(node_set(mesh, nodes, place), size_t(mesh.node_count()));
    start_.clear();
    for (NodeId n : reaction.nodes) start_.push_back(dot(mesh.X[n], direction));
  }
  void before_drift(State& s, double dt) {
    reaction.for_due(
        s, dt, [&](double h) { return table.at(s.t + h); },
        [&](size_t i, NodeId n, double h, double displaced) {
          const double along = (start_[i] + displaced - dot(s.x[n], direction)) / h;
          reaction.set_velocity(s, n, along * direction + free_part(s.v[n]));
        });
  }
  void on_force(State& s, double dt) {
    reaction.for_due(s, dt, [&](size_t i, NodeId n, double h) {
      const Vec3& f = s.f[n];
      reaction.take_force(s, i, f - free_part(f), h);
    });
  }
  void after_kick(State&, double) {}  // the velocity of the step stands for that at its end

 private:
  Vec3 free_part(const Vec3& v) const { return across == "free" ? v - dot(v, direction) * direction : Vec3{}; }
  std::vector<double> start_;  // per reaction.nodes: m, along the direction
};

}  // namespace bw::csd
