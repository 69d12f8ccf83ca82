// SPDX-License-Identifier: Apache-2.0
// [[fluid.vortex]]: isentropic vortices in the gas of the regions, steady in a gas at rest and carried by one that
// moves [Shu, NASA CR-97-206253 (1997), 5.1]:
//   v_theta = speed (r/R) e^((1 - r^2/R^2)/2),  h = h_0 - v_theta^2 R^2/(2 r^2),  entropy as around it.
#pragma once
#include <string>

#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw::cfd {

struct Model;

struct VortexCase {
  Vec3 centre;
  std::string axis = "z", place;
  double radius = 0, speed = 0;
  template <class K>
  void describe(K& k) {
    k.required("centre", centre, dim::length, "a point of its axis");
    k.choice("axis", axis, {"x", "y", "z"}, "its direction");
    k.required("radius", radius, dim::length, "where it turns fastest");
    k.required("speed", speed, dim::velocity, "there; above 0: counterclockwise, seen against the axis");
    k.expect(radius > 0, "radius", "a positive length");
    place = k.where("radius");
  }
};

/// Adds it to the cells of one ideal or stiffened gas; means over the cells. InputError where a cell holds something
/// else or the gas can't turn so fast.
void paint_vortex(Model& m, const VortexCase& vortex);

}  // namespace bw::cfd
