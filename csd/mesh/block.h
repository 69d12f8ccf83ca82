// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "common/math/units.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// A brick of elements between any eight corners, trilinear. Sets of nodes and faces as for the box, by the parameters:
/// x_lower .. z_upper.
struct Block {
  std::vector<Vec3> corners;
  std::vector<int> cells{1, 1, 1};
  bool is_split = false;
  static constexpr auto name = "block";
  template <class K>
  void describe(K& k) {
    k.required(
        "corners", corners, dim::length,
        "eight: the lower four around, counter-clockwise from the first seen from the upper ones, then the upper "
        "four above them");
    k.required("cells", cells, "elements along the edges from the first corner to the second, fourth, fifth");
    k.expect(corners.size() == 8, "corners", "eight points");
    k.expect(cells.size() == 3 && cells[0] > 0 && cells[1] > 0 && cells[2] > 0, "cells", "three counts of at least 1");
    k.expect(double(cells[0]) * cells[1] * cells[2] <= most_elements, "cells", few_enough);
    k.optional("split", is_split, "each hex through six tetrahedra into 24 hexes");
  }
  Mesh make() const;
};

/// A ball, hollow or solid, of a core cube and layers around it: all of it or the octant of positive coordinates. Sets
/// of nodes and faces: outer, inner (hollow), and cut_x, cut_y, cut_z of the octant.
struct Ball {
  double radius = 0, inner_radius = 0;
  int across = 4, through = 4;
  std::string sector = "octant";
  static constexpr auto name = "ball";
  template <class K>
  void describe(K& k) {
    k.required("radius", radius, dim::length, "outer radius; the centre is the origin");
    k.optional("inner_radius", inner_radius, dim::length, "of the cavity; 0: solid");
    k.required("across", across, "elements along a quarter of the equator, over two");
    k.required("through", through, "layers from the core (or cavity) to the surface");
    k.choice("sector", sector, {"full", "octant"}, "the whole, or x, y, z >= 0 between three planes of symmetry");
    k.expect(radius > 0, "radius", "a positive length");
    k.expect(inner_radius >= 0 && inner_radius < radius, "inner_radius", "a length from 0 to less than the radius");
    k.expect(across >= 1, "across", "at least 1");
    k.expect(through >= 1, "through", "at least 1");
    k.expect(3.0 * across * across * through <= most_elements, "across", few_enough);
  }
  Mesh make() const;
};

}  // namespace bw::csd
