// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "common/math/units.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// A brick of nx x ny x nz hexahedra. Sets of nodes and faces: x_lower, x_upper, y_lower ... z_upper.
struct Box {
  Vec3 lower{0, 0, 0}, upper{1, 1, 1}, grading{1, 1, 1};
  std::vector<int> cells{1, 1, 1};
  bool is_split = false;
  static constexpr auto name = "box";
  template <class K>
  void describe(K& k) {
    k.required("lower", lower, dim::length, "corner with the smallest coordinates");
    k.required("upper", upper, dim::length, "corner with the largest coordinates");
    k.expect(upper.x > lower.x && upper.y > lower.y && upper.z > lower.z, "upper",
             "a corner above `lower` in x, y and z");
    k.required("cells", cells, "elements along x, y, z");
    k.expect(cells.size() == 3 && cells[0] > 0 && cells[1] > 0 && cells[2] > 0, "cells", "three counts of at least 1");
    k.optional("grading", grading, dim::none, "length of the last element over the first, along x, y, z");
    k.expect(double(cells[0]) * cells[1] * cells[2] <= most_elements, "cells", few_enough);
    k.expect(grading.x > 0 && grading.y > 0 && grading.z > 0, "grading", "three positive ratios");
    k.optional("split", is_split, "each hex through six tetrahedra into 24 hexes");
  }
  Mesh make() const;
};

}  // namespace bw::csd
