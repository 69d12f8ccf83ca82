// SPDX-License-Identifier: Apache-2.0
// What a case wants to be recorded at points, on planes and in the whole domain.
#pragma once
#include <string>
#include <vector>

#include "common/io/keys.h"

namespace bw::cfd {

struct GaugeCase {
  std::string name, place;
  Vec3 position;
  template <class K>
  void describe(K& k) {
    k.required("name", name, "names its columns in fluid_gauges.csv and its entry in fluid_gauges.json");
    k.required("position", position, dim::length,
               "where, inside the domain; values are linear between the cells around it");
    place = k.where("position");
  }
};

/// A cut through the domain as a grid of points.
struct PlaneCase {
  std::string name, normal, place;
  double at = 0, every = 0;
  Vec3 lower{-1e300, -1e300, -1e300}, upper{1e300, 1e300, 1e300};
  std::vector<int> cells;
  bool maps = true;
  template <class K>
  void describe(K& k) {
    k.required("name", name, "names its files, plane_<name>_*.vtkhdf");
    k.choice("normal", normal, {"x", "y", "z"}, "direction across the plane");
    k.required("at", at, dim::length,
               "its coordinate in that direction; values are linear between the cells around a point");
    k.optional("lower", lower, dim::length, "the plane begins here, if not at the side of the domain");
    k.optional("upper", upper, dim::length, "the plane ends here, if not at the side of the domain");
    k.optional("cells", cells,
               "values along its two directions, in the order x, y, z; none given: one per finest cell");
    k.optional("every", every, dim::time, "interval of its files, after the step that passes it; 0: one at the end");
    k.optional("maps", maps, "peak overpressure, impulse, arrival and duration up to then as well (from every step)");
    k.expect(!name.empty() && name.find('/') == std::string::npos, "name", "a name without /");
    k.expect(cells.empty() || (cells.size() == 2 && cells[0] > 0 && cells[1] > 0), "cells", "two positive numbers");
    k.expect(every >= 0, "every", "a positive time, or 0 for one file at the end");
    k.expect(lower.x < upper.x && lower.y < upper.y && lower.z < upper.z, "upper", "a point above lower in x, y and z");
    place = k.where("at");
  }
};

/// Peak overpressure and impulse in the whole domain.
struct MapCase {
  std::vector<int> cells;
  template <class K>
  void describe(K& k) {
    k.optional("cells", cells, "values in x, y, z; none given: one per cell of level 0");
    k.expect(cells.empty() || (cells.size() == 3 && cells[0] > 0 && cells[1] > 0 && cells[2] > 0), "cells",
             "three positive numbers");
  }
};

}  // namespace bw::cfd
