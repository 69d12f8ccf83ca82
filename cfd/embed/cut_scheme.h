// SPDX-License-Identifier: Apache-2.0
// The kernels of blocks with walls behind one door: compiled once per pair of equations of state, one call per block.
#pragma once
#include <memory>
#include <vector>

#include "cfd/embed/patch_cuts.h"
#include "cfd/mix/list.h"
#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

/// What the gas meets at a cut link.
enum class WallTreatment {
  half_riemann,  ///< the wall where it is, at the end of a line through the cells: half a Riemann problem; second order
  first_order,   ///< the mirror image of the cell itself, as if the wall were at the cell face
  mirror,        ///< mirror images of points before the wall, on reconstructed gradients, with dp/dn = -rho a_n
  cut_cell,      ///< open volumes and cell faces as they are, conservative (cfd/cut/cells.h)
};

/// What the fluid of a block lost through cut links in one step.
struct WallExchange {
  double mass = 0;    ///< kg: a defect of link walls, not a leak
  Vec3 momentum;      ///< kg m/s: the impulse on the walls
  double energy = 0;  ///< J: the work on the walls, and a defect
  int64_t links = 0;
  WallExchange& operator+=(const WallExchange& o) {
    mass += o.mass, momentum += o.momentum, energy += o.energy, links += o.links;
    return *this;
  }
};

/// What one cut link gave to the face that it crosses.
struct LinkLoad {
  int32_t face = -1;  ///< -1: none
  Vec3 impulse;       ///< N s, absolute pressure, in a frame that moves with the wall along the link
  Vec3 area_time;     ///< m^2 s: what one Pa at rest would have given
  Vec3 at;            ///< the crossing at mid-step [m]
  double rho_c = 0;   ///< kg/(m^2 s), of the gas there; of cut cells, whose faces have no probes
};

/// What a wall feels at one point.
struct WallLoad {
  double p = 0;      ///< Pa, >= 0
  double rho_c = 0;  ///< kg/(m^2 s), of the gas there
};

/// One per thread; `shape` as in the patches.
class CutScheme {
 public:
  virtual ~CutScheme() = default;
  /// What BlockKernel::advance then takes; valid until the next. Nothing is damped beside walls (cfd/scheme/carbuncle.h).
  virtual const CutFaces& prepare(Patch& patch, const PatchCuts& cuts, double dt) = 0;
  /// After prepare() and BlockKernel::advance with the same patch, flow and dt: adds what walls give through cut faces to
  /// `change`, which means nothing in blocked cells. exchange, and links unless nullptr: added to.
  virtual void correct(BlockChange& change, WallExchange& exchange, std::vector<LinkLoad>* links) = 0;
  /// For load() without prepare(): dt = 0 gives loads at the patch's own time.
  virtual void begin(const Patch& patch, const PatchCuts& cuts, double dt) = 0;
  /// Pressure at x on a wall with unit normal n into the fluid and velocity v, dt/2 after the patch's time, seen from
  /// the open cell (i, j, k) of the block: second order from its own side, then the half-Riemann wall.
  virtual WallLoad load(const Index3& cell, const Vec3& x, const Vec3& n, const Vec3& v) = 0;
};

/// For patches of MixedFlow; also of one material, if all rows are filled. The mixture must outlive it.
std::unique_ptr<CutScheme> make_cut_scheme(const Mixture& mixture, const BlockShape& shape,
                                           WallTreatment treatment = WallTreatment::half_riemann);
/// For patches of one gas.
std::unique_ptr<CutScheme> make_cut_scheme(const GasFlow& gas, const BlockShape& shape,
                                           WallTreatment treatment = WallTreatment::half_riemann);

}  // namespace bw::cfd
