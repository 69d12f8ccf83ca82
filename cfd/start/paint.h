// SPDX-License-Identifier: Apache-2.0
// A profile along a radius as the state at the start of another run: of a box of cells in 3-D (a ball, or a cylinder
// along an axis; in 2-D a cylinder), or along the same kind of radius with other cells.
#pragma once
#include "cfd/start/case.h"
#include "cfd/start/profile.h"

namespace bw::cfd {

struct Start {
  Profile profile;
  Vec3 centre;
  int axis = 2;               ///< of a cylinder
  double reach = 0;           ///< the regions of the case hold beyond [m]
  int row[Cons::most] = {};   ///< where a row of the profile goes; alpha1 apart
  bool swapped = false;       ///< its material 1 is material 2 here
  std::string place;
};

/// Reads the profile and checks that it fits: materials, geometry, and that it lies in the domain but for planes of
/// symmetry (walls) through its centre. InputError otherwise.
Start begin_from(const StartCase& in, const Model& m);
/// Each cell's share of the profile's mass, energy and volume of material by exact volumes; momentum along the mean
/// direction of the radius in the cell. What lies beyond `reach` stays. report: says what came in.
void paint_profile(Model& m, const Start& start, bool report);

}  // namespace bw::cfd
