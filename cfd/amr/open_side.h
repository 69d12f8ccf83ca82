// SPDX-License-Identifier: Apache-2.0
// Ghost states of open sides. n outward, u = v.n:
//   far_field        waves that leave carry what the last cell says; the one that enters lies between the last cell's
//   (a copy)
//                    and the given state's, p - rho c u [Hirsch 1990, 19.1]; u < 0: gas that enters has the given
//                    entropy, composition and velocity along the side; u < -c: all is given
//   subsonic_inflow  density and velocity are given; the pressure follows from the wave that leaves, dp = -rho c du
#pragma once
#include "cfd/amr/boundary.h"
#include "cfd/amr/patch.h"
#include "cfd/medium.h"

namespace bw::cfd {

/// Does the side take its ghosts from here?
inline bool is_open(SideKind kind) { return kind == SideKind::far_field || kind == SideKind::subsonic_inflow; }

/// Overwrites the ghosts of a filled patch behind side 2 d + upper, which is a side of the domain. all_rows: as the
/// patch was filled.
void fill_open_side(const Medium& medium, const BoundarySide& side, int d, bool upper, bool all_rows, Patch& patch);

}  // namespace bw::cfd
