// SPDX-License-Identifier: Apache-2.0
// The solid that fsi-check plays: a cube of two halves, side by side in x, which may break apart.
#pragma once
#include "coupling/surface.h"

namespace bw::coupling::check {

/// Ten faces: one at either end in x, two on each of the other sides; normals outwards.
WetSurface cube(const Vec3& centre, double edge);
/// The halves get nodes of their own in the middle and a lip each; all orders are turned round.
void split(WetSurface& surface);
/// A quad and a triangle without area, and a side of two triangles instead of a quad.
void degenerate(WetSurface& surface);

}  // namespace bw::coupling::check
