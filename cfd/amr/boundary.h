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
};

struct BoundarySide {
  SideKind kind = SideKind::wall;
  double U[Cons::count] = {};  ///< inflow: the conserved state
};
/// x lower, x upper, y lower ...
struct Boundary {
  BoundarySide side[6];
};

}  // namespace bw::cfd
