// SPDX-License-Identifier: Apache-2.0
// The room inside a surface: cells for the explosive, and its exact volume.
#pragma once
#include <vector>

#include "cfd/embed/cut_map.h"
#include "coupling/surface.h"

namespace bw::cfd {

struct Cavity {
  std::vector<Index3> cells;      ///< reached from the seed through uncut links
  bool reaches_boundary = false;  ///< of the lattice: the surface does not enclose the seed
  double cell_volume = 0;         ///< m^3, of the cells
  double exact_volume = 0;  ///< m^3, enclosed by the components of the surface around the seed; 0: none is around it
};

/// Empty cells if the seed's cell is in metal or outside.
Cavity find_cavity(const coupling::WetSurface& surface, const CutMap& map, const Vec3& seed);

/// Volume inside each component of the surface (faces connected by nodes), positive with normals pointing out of it.
/// component: [n_faces].
std::vector<double> component_volumes(const coupling::WetSurface& surface, std::vector<int32_t>& component);

}  // namespace bw::cfd
