// SPDX-License-Identifier: Apache-2.0
// Openings narrower than a cell. A link between two centres is cut or it is not; beside the edge of a thin wall and
// in a crack the truth lies between: of the cell face that the link stands for, a wall blocks a part. Its area is
// found by clipping the wall's triangles with the box over that face from centre to centre, exactly, so that it grows
// with the opening and doesn't depend on where the grid lies.
#pragma once
#include "cfd/embed/cut_map.h"
#include "coupling/surface.h"

namespace bw::cfd {

/// What happens where a wall blocks a part of a cell face.
enum class Slits {
  centre,  ///< the line between the centres decides: all or nothing
  area,    ///< gas flows through the open part
  sealed,  ///< nothing passes
};

/// Adds the apertures of a scanned map: of links between two open cells at free and sharp edges of the surface. Layers
/// of a closed body (its front and its back) block once. `slits` is not `centre`.
void find_apertures(const coupling::WetSurface& surface, Slits slits, CutMap& map);

}  // namespace bw::cfd
