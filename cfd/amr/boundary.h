// SPDX-License-Identifier: Apache-2.0
// What lies behind the sides of the domain.
#pragma once
#include "cfd/mix/variables.h"

namespace bw::cfd {

enum class SideKind {
  wall,      ///< rigid, smooth: the mirror image
  outflow,   ///< the last cell once more
  periodic,  ///< the other side
  inflow,    ///< a constant state
  far_field,        ///< characteristics: what leaves leaves, what enters comes from a constant state
  subsonic_inflow,  ///< density and velocity of a constant state, pressure by the wave that leaves
};

struct BoundarySide {
  SideKind kind = SideKind::wall;
  double U[Cons::most] = {};  ///< inflow, far_field, subsonic_inflow: the conserved state
  double across = 1;           ///< m, from here to the other side of the domain
  bool has_state() const { return kind == SideKind::inflow || kind == SideKind::far_field || kind == SideKind::subsonic_inflow; }
};
/// x lower, x upper, y lower ...
struct Boundary {
  BoundarySide side[6];
};

}  // namespace bw::cfd
