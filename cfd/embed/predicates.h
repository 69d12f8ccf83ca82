// SPDX-License-Identifier: Apache-2.0
// On which side of a line or a triangle does a point lie? Exact for doubles, so there is no tolerance and no unit in
// it, and never "on": the query point is moved by the same infinitesimal vector (e1, e2, e3), e1 >> e2 >> e3 > 0, in
// every question ("simulation of simplicity", Edelsbrunner & Muecke 1990). All answers then belong to one generic
// point: a line through an edge or a vertex of a watertight surface meets exactly one of the faces around it.
#pragma once
#include "common/math/tensor.h"

namespace bw::cfd {

/// Sign (-1, +1) of (b - a) x (q - a) for q moved by (e, e^2); 0 only if a == b.
int side_of_line(double ax, double ay, double bx, double by, double qx, double qy);

/// Sign (-1, +1) of (b - a) x (c - a) . (q - a) for q moved by (e, e^2, e^3): +1 on the side of the normal; 0 only for
/// a triangle without area.
int side_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& q);

}  // namespace bw::cfd
