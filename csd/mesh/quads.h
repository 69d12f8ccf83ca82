// SPDX-License-Identifier: Apache-2.0
// Quad meshes of plane figures, and the hexahedra swept out between copies of them.
#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Points and counter-clockwise quads in a plane (or in the two parameters of a surface).
struct Quads {
  struct Point {
    double x, y;
  };
  std::vector<Point> p;
  std::vector<std::array<int32_t, 4>> quad;
};

/// nx x ny cells of the unit square, point i + j (nx + 1).
Quads quad_grid(int nx, int ny);
/// Ring 1 <= hypot(x, y) <= 2 (the radius counts layers: 1 + r / rings), `around` cells: point b + r * around at the
/// angle of b.
Quads quad_annulus(int around, int rings);
/// Unit disc without a degenerate centre: a core of (2 core)^2 cells inside `rings` rings of 8 core cells
/// ("butterfly"), which
/// begin at the radius `middle` on the axes. The last 8 core points are the rim, counter-clockwise from -45 degrees.
Quads quad_disc(int core, int rings, double middle);
/// Only the quads in x >= 0 and y >= 0 ("quarter"), y >= 0 ("half") or all ("full").
Quads cut_sector(const Quads& q, const std::string& sector);
/// Unit vector of the angle 2 pi b / n, exact at the quarters if n is a multiple of 4.
Quads::Point on_circle(int b, int n);

/// Where a node of a swept mesh comes from: up to four (point, layer) pairs whose mean it is (one, unless the hexes
/// were split).
struct Swept {
  Mesh mesh;
  std::vector<std::array<int32_t, 4>> origin;
  int points = 0;
  /// Node set and boundary face set of the nodes all of whose origins satisfy holds(point, layer).
  void add_set(const std::string& name, const std::function<bool(int, int)>& holds);

 private:
  std::vector<Face> boundary_;
};

/// Hexahedra between layers 0..n of copies of the quads; place(point, layer) is a position. `is_split`: each hex
/// through six tets into 24 hexes. body = 0, gids in order of making.
Swept sweep(const Quads& q, int layers, const std::function<Vec3(int, int)>& place, bool is_split = false);

/// Local (x, y, z) with z along `axis` "x", "y" or "z", moved to `base`: cyclic, so that no orientation changes.
Vec3 along_axis(const std::string& axis, const Vec3& base, const Vec3& local);
/// Names of the global axes that the local x and y lie along.
std::array<std::string, 2> cross_axes(const std::string& axis);

/// 0 .. 1 in n steps, the last `grading` times as long as the first.
std::vector<double> graded(int n, double grading);

}  // namespace bw::csd
