// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/block.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "csd/mesh/box.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

Mesh Block::make() const {
  Box unit;
  unit.lower = {-1, -1, -1}, unit.cells = cells, unit.is_split = is_split;
  Mesh mesh = unit.make();
  for (Vec3& x : mesh.X) {
    const Vec3 xi = x;
    x = {};
    for (int a = 0; a < 8; ++a)
      x += (0.125 * (1 + hex_sign[a][0] * xi.x) * (1 + hex_sign[a][1] * xi.y) * (1 + hex_sign[a][2] * xi.z)) *
           corners[size_t(a)];
  }
  return mesh;
}

namespace {

using Place = std::array<int, 4>;  // in the core's grid, and layer from it

/// Positions of core and layers; the core is a cube of half the radius, a little bulged.
class BallGrid {
 public:
  BallGrid(const Ball& ball) : ball_(ball), first_(ball.sector == "octant" ? 0 : -ball.across) {}
  int first() const { return first_; }
  Vec3 at(const Place& p) const {
    const Vec3 q = cube(p), on_sphere = unit(angles(p));
    const double r = ball_.inner_radius;
    const Vec3 begin = r > 0 ? r * on_sphere : 0.5 * ball_.radius * bulged(q);
    const double s = double(p[3]) / ball_.through;
    return p[3] == 0 ? begin : begin + s * (ball_.radius * on_sphere - begin);
  }

 private:
  Vec3 cube(const Place& p) const { return (1.0 / ball_.across) * Vec3{double(p[0]), double(p[1]), double(p[2])}; }
  /// Of a point on the cube: equal angles between neighbours.
  Vec3 angles(const Place& p) const {
    const auto tangent = [&](int i) {
      return i == ball_.across ? 1.0 : i == -ball_.across ? -1.0 : std::tan(std::numbers::pi / 4 * i / ball_.across);
    };
    return {tangent(p[0]), tangent(p[1]), tangent(p[2])};
  }
  static Vec3 bulged(const Vec3& q) {
    const double most = std::max({std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)});
    return most > 0 ? 0.4 * q + (0.6 * most / norm(q)) * q : q;
  }
  const Ball& ball_;
  int first_;
};

}  // namespace

Mesh Ball::make() const {
  const BallGrid grid(*this);
  const int n = across, first = grid.first();
  Mesh mesh;
  std::map<Place, NodeId> known;
  const auto node = [&](const Place& p) {
    const auto [it, is_new] = known.try_emplace(p, NodeId(mesh.node_count()));
    if (is_new) {
      mesh.X.push_back(grid.at(p));
      mesh.node_gid.push_back(mesh.node_gid.size());
      mesh.parent.push_back(NodeId());
    }
    return it->second;
  };
  const auto add = [&](const std::array<Place, 8>& p) {
    std::array<NodeId, 8> h;
    for (size_t a = 0; a < 8; ++a) h[a] = node(p[a]);
    HexCorners c = corners(h, mesh.X);
    if (hex_volume(c).volume < 0) std::swap(h[1], h[3]), std::swap(h[5], h[7]);
    mesh.elem_gid.push_back(mesh.elem_count());
    mesh.hex.push_back(h);
    mesh.body.push_back(0);
  };
  for (int k = first; inner_radius == 0 && k < n; ++k)
    for (int j = first; j < n; ++j)
      for (int i = first; i < n; ++i)
        add({{{i, j, k, 0},
              {i + 1, j, k, 0},
              {i + 1, j + 1, k, 0},
              {i, j + 1, k, 0},
              {i, j, k + 1, 0},
              {i + 1, j, k + 1, 0},
              {i + 1, j + 1, k + 1, 0},
              {i, j + 1, k + 1, 0}}});
  for (int d = 0; d < 3; ++d)
    for (const int side : {-n, n}) {
      if (side < first) continue;
      for (int j = first; j < n; ++j)
        for (int i = first; i < n; ++i)
          for (int l = 0; l < through; ++l) {
            const auto at = [&](int a, int b, int layer) {
              Place p{};
              p[size_t(d)] = side, p[size_t((d + 1) % 3)] = a, p[size_t((d + 2) % 3)] = b, p[3] = layer;
              return p;
            };
            add({at(i, j, l), at(i + 1, j, l), at(i + 1, j + 1, l), at(i, j + 1, l), at(i, j, l + 1),
                 at(i + 1, j, l + 1), at(i + 1, j + 1, l + 1), at(i, j + 1, l + 1)});
          }
    }
  std::vector<Place> place_of(known.size());
  for (const auto& [place, id] : known) place_of[size_t(id)] = place;
  const auto boundary = boundary_faces(mesh);
  const auto set = [&](const char* set_name, const auto& holds) {
    add_set(mesh, boundary, set_name, [&](NodeId id) { return holds(place_of[size_t(id)]); });
  };
  set("outer", [&](const Place& p) { return p[3] == through; });
  if (inner_radius > 0) set("inner", [&](const Place& p) { return p[3] == 0; });
  if (sector == "octant") {
    set("cut_x", [](const Place& p) { return p[0] == 0; });
    set("cut_y", [](const Place& p) { return p[1] == 0; });
    set("cut_z", [](const Place& p) { return p[2] == 0; });
  }
  return mesh;
}

}  // namespace bw::csd
