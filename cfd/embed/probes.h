// SPDX-License-Identifier: Apache-2.0
// Where each wet face asks the fluid for its pressure: an open cell on its own side. A face of a closed body has one
// side, a face of a thin shell two.
#pragma once
#include <functional>
#include <vector>

#include "cfd/embed/cut_map.h"
#include "coupling/surface.h"

namespace bw::cfd {

struct Probe {
  int32_t face = -1;
  int32_t side = 1;  ///< +1: the side of the normal, -1: the back of a thin face
  Index3 cell{};     ///< of the lattice, holds fluid
  Vec3 x;            ///< mean of the face's nodes [m]
  Vec3 n;            ///< unit normal into this fluid
  Vec3 v;            ///< mean velocity [m/s]
};

/// One probe per face and wet side that sees fluid within two cells along its normal, in the order of the faces; the
/// others are dry: in metal, in a gap too narrow for a cell, outside the lattice, or without area.
std::vector<Probe> find_probes(const coupling::WetSurface& surface, const CutMap& map);
/// The same in groups, 0 <= group_of(cell) < groups, in a group in the order of the faces; first: where each group
/// begins in probes [groups + 1].
void find_probes(const coupling::WetSurface& surface, const CutMap& map, size_t groups,
                 const std::function<size_t(const Index3&)>& group_of, std::vector<Probe>& probes,
                 std::vector<size_t>& first);

}  // namespace bw::cfd
