// SPDX-License-Identifier: Apache-2.0
// What the gas at a wet face does inside a window. A fluid that is asked once a window answers the velocity that it was
// told; a wall whose own vibration is as fast as the windows then gets its pressure at the wrong time, and may gain
// energy from it. Sound leaves a wall at once: a face that moves differently from what was told feels
//   -rho c (v - w) . n                                                                    [Pa, on the solid along n]
// on top, as in linear acoustics, whatever w was. The impulse of it is given back in the next window, where the fluid
// repays the gap: over the run the solid gets what the fluid gave.
#pragma once
#include <array>
#include <vector>

#include "common/data/csr.h"
#include "csd/mesh/mesh.h"
#include "csd/state.h"

namespace bw::csd {

/// The wet faces in one window, lists of one length.
struct RadiatingFaces {
  std::vector<Face> face;
  std::vector<Vec3> n;            ///< unit, into the fluid
  std::vector<double> told;       ///< m/s along n: the mean of its nodes that the fluid was told
  std::vector<double> impedance;  ///< rho c times area [kg/s]; 0: none

  size_t size() const { return face.size(); }
};

class Radiation {
 public:
  /// A window begins: its faces, and the largest h c/m of a node (h: its longest step; c: a quarter of the impedances
  /// around it). Beyond it impedances are taken smaller, so that the step stays stable: with forces by the last
  /// half-step's velocity that needs (h/h_stable)^2 + h c/(2 m) < 1. They are found anew when nodes were split, whose
  /// children are lighter, and when steps become longer, of all nodes or by renew().
  void begin(const Mesh& mesh, const State& s, RadiatingFaces faces, double largest);
  /// Steps of nodes have changed: the bound is taken anew.
  void renew() { dt_ = 0; }
  /// Forces at s.v, added to f. Of at most `alone` nodes or faces no other thread is woken.
  void add(const Mesh& mesh, const State& s, Field<Vec3, NodeId>& f, int64_t alone);
  /// The last add() acts for the time h, at s.v, on nodes that are due; nodes may have been split since.
  void book(const Mesh& mesh, const State& s, double h);
  /// Since begin, of each of its faces [N s].
  const std::vector<Vec3>& impulses() const { return impulse_; }
  /// J, likewise.
  double work() const { return work_; }

  /// In a checkpoint, between two windows.
  template <class A>
  void keep(A& a) {
    a.list("impulse", impulse_);
  }

 private:
  void fit(const Mesh& mesh);
  void bound(const State& s);

  RadiatingFaces faces_;        // none if none has an impedance
  std::vector<double> acting_;  // kg/s: part of their impedances
  std::vector<double> force_;   // N along n, of them
  std::vector<Vec3> impulse_;
  double work_ = 0;
  double largest_ = 0, dt_ = 0;  // bound; stable step [s] for which it was taken, 0: it must be taken anew
  // whose nodes are whose
  size_t mesh_nodes_ = 0;
  std::vector<NodeId> nodes_;                   // of all faces, each once
  std::vector<std::array<int32_t, 4>> corner_;  // [face] into nodes_
  Csr<int32_t> around_;                         // [nodes_] faces, ascending
};

}  // namespace bw::csd
