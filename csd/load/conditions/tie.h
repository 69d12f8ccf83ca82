// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "common/math/units.h"
#include "csd/load/conditions/reaction.h"

namespace bw::csd {

/// Bodies glued together: each node of a set follows the point of a face that it touches at the start (to within
/// `tolerance`), and hands its force and inertia to the face's nodes. Meshes need not match: the finer side's nodes are
/// tied to the coarser side's faces. Linear momentum is kept exactly, for matching meshes it is as if they were one;
/// otherwise the inertia of the tied nodes is lumped on the faces' nodes, and what that changes in energy is booked.
struct Tie {
  static constexpr auto name = "tie";
  static constexpr bool is_tie = true;
  std::string nodes, place, place_faces;
  std::vector<std::string> faces;
  double tolerance = 0;
  Reaction reaction;

  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set that is tied");
    k.required("faces", faces, "names of the face sets that it is tied to");
    k.optional("tolerance", tolerance, dim::length,
               "nodes farther from the faces stay free; 0: a hundredth of the faces' size");
    k.expect(tolerance >= 0, "tolerance", "a length >= 0");
    if (!k.is_manual()) place = k.where("nodes"), place_faces = k.where("faces");
  }
  /// InputError if no node lies at the faces.
  void select(const Mesh& mesh);
  void before_drift(State& s, double) { follow(s); }
  /// First of all conditions: forces and masses go to the faces' nodes, and all accelerate alike.
  void on_force(State& s, double dt);
  void after_kick(State& s, double) { follow(s); }
  size_t tied() const { return ties_.size(); }

 private:
  struct Point {  // on a face
    int32_t follower;
    int32_t corner[4];  // into reaction.nodes, all
    double N[4];
  };
  void follow(State& s);
  std::vector<Point> ties_;
  std::vector<Vec3> force_;   // work space, per reaction.nodes: N
  std::vector<double> mass_;  // kg
};

}  // namespace bw::csd
