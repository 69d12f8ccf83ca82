// SPDX-License-Identifier: Apache-2.0
// The surface met by the grid lines through the cell centres.
#pragma once
#include "cfd/embed/cut_map.h"
#include "coupling/surface.h"

namespace bw::cfd {

/// A quad is a fan of four triangles around the mean of its nodes: the same for its opposite lip, whatever the node
/// order, smooth in time, with the area vector 1/2 d13 x d24. A triangle (last node twice) stays one. visit(a, b, c, i,
/// j): the corners, and the local nodes of a and b; c is the fan's centre, or node 2 of a triangle.
template <class T, class Visit>
void for_each_triangle(const std::vector<Vec<T>>& x, const std::array<int32_t, 4>& q, const Visit& visit) {
  if (q[2] == q[3]) {
    visit(x[q[0]], x[q[1]], x[q[2]], 0, 1);
    return;
  }
  const Vec<T> c = 0.25 * ((x[q[0]] + x[q[2]]) + (x[q[1]] + x[q[3]]));
  for (int i = 0; i < 4; ++i) visit(x[q[i]], x[q[(i + 1) % 4]], c, i, (i + 1) % 4);
}

/// Fills the map: cut links, and cells whose centre lies in a closed body (winding number > 0, faces with face_thin not
/// counted). Cost is linear in faces and crossings. Same result for any number of threads. Returns whether all grid
/// lines left all metal that they entered; of an open surface (a wet part of a solid) what lies behind along a grid
/// line counts as metal.
bool scan(const coupling::WetSurface& surface, const Lattice& lattice, CutMap& map);

/// The walls' velocities at all crossings, from surface.v: the surface has other velocities now, at the same places.
void update_velocities(const coupling::WetSurface& surface, CutMap& map);
/// Likewise their accelerations along the normals, from `a` [n_nodes, m/s^2].
void update_accelerations(const coupling::WetSurface& surface, const std::vector<Vec3>& a, CutMap& map);

}  // namespace bw::cfd
