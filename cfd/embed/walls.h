// SPDX-License-Identifier: Apache-2.0
// All embedded walls of a run on one lattice, window by window:
//
//   walls.begin(surface, x, v);            // where the walls are and go; cells that a crack freed: refill as below
//   dt = min(dt, walls.largest_step());
//   each block with walls.near(...):       // in any order, on any thread
//     cuts.gather(walls.map(), walls.rules(), first_cell);
//     CutScheme::prepare; BlockKernel::advance with its CutFaces; CutScheme::correct;
//     for (i in walls.probes_of(...)) walls.set_load(i, scheme.load(...));
//   loads = walls.loads(dt, ...);          // after a sum of walls.values() over ranks
//   walls.end(x_end);                      // the nodes have arrived
//   for (layer = 1 .. walls.changes().layers):         // ghosts exchanged before each
//     gather and refill the fresh cells of this layer; walls.accept(layer);
//
// Every rank holds all walls and gets the same map.
#pragma once
#include <unordered_map>
#include <vector>

#include "cfd/cut/cells.h"
#include "cfd/embed/apertures.h"
#include "cfd/embed/cut_scheme.h"
#include "cfd/embed/lips.h"
#include "cfd/embed/motion.h"
#include "cfd/embed/probes.h"
#include "common/io/checkpoint.h"
#include "coupling/loads.h"
#include "coupling/node_places.h"

namespace bw::cfd {

/// Forces of the cut links on the faces that they cross, above p_ref.
struct FaceForces {
  std::vector<uint8_t> met;  ///< [n_faces] by a link
  std::vector<Vec3> force;   ///< [n_faces] N
  std::vector<Vec3> moment;  ///< [n_faces] N m about the origin, levers are the crossings
  std::vector<double> rho_c_area;  ///< [n_faces] kg/s, of cut cells; else 0
};

/// [fluid.walls]
struct WallOptions {
  Slits slits = Slits::centre;
  WallTreatment treatment = WallTreatment::half_riemann;
  bool conservative = false;  ///< loads
};

class Walls {
 public:
  /// block: cells per block and direction; p_ref [Pa]: on faces that see no fluid.
  Walls(const Lattice& lattice, const GhostRules& rules, const std::array<int, 3>& block, double p_ref,
        const WallOptions& options = {});

  /// A window starts: nodes are at x and keep v for the window [n_nodes]. Rescans if the topology is new or the nodes
  /// are not where end() left them.
  void begin(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v);
  /// The window will last dt, nodes will be at x_end: walls whose velocity is another than in the last one are
  /// accelerated. Unless it is called before the step, and in the first window, the treatment `mirror` takes them for
  /// unaccelerated. The treatment `cut_cell` needs it.
  void set_step(double dt, const std::vector<Vec3>& x_end);
  /// The window is over: nodes are at x_end.
  void end(const std::vector<Vec3>& x_end);
  /// s; no wall goes further than half a cell.
  double largest_step() const;

  // --- cells
  // ---------------------------------------------------------------------------------------------------------------
  const CutMap& map() const { return map_; }
  const GhostRules& rules() const { return rules_; }
  /// What the last begin() or end() did. Covered cells still hold their last state; fresh ones wait for theirs.
  const Changes& changes() const { return changes_; }
  void accept(int layer);
  /// Can walls matter to the block with this first cell?
  bool near(const Index3& first_cell) const;

  // --- loads
  // ---------------------------------------------------------------------------------------------------------------
  /// Probes whose cell is in the block with this first cell: [first, last) of probes().
  struct Range {
    size_t first, last;
  };
  Range probes_of(const Index3& first_cell) const;
  const std::vector<Probe>& probes() const { return probes_; }
  void set_load(size_t probe, const WallLoad& load) {
    values_[2 * probe] = load.p;
    values_[2 * probe + 1] = load.rho_c;
  }
  /// p and rho c by probe; zero where another rank has the block.
  std::vector<double>& values() { return values_; }
  /// Pressure and impedance per face, and dry faces, from values(). A thin face carries the difference of its sides on
  /// top of p_ref. A lip carries p_ref until its crack is wide enough to see fluid; then its pressure goes to the
  /// fluid's while the crack opens by half a cell more.
  coupling::Loads loads();
  /// Do faces carry what the cut links across them gave? loads() then adds the traction that makes it so on the areas of
  /// the surface that was given to begin(); lips are not blended.
  bool conservative() const { return options_.conservative || cut_; }
  WallTreatment treatment() const { return options_.treatment; }
  /// Before loads(): of the window of dt.
  void set_links(const std::vector<LinkLoad>& links, double dt);
  const FaceForces& face_forces() const { return face_forces_; }
  /// Impulse that the blending of lips kept from the walls at the last loads() [N s per s of window].
  Vec3 lip_force() const { return lip_force_; }

  const coupling::WetSurface& surface() const { return surface_; }
  /// Of the treatment `cut_cell`; nullptr with the others.
  CutCells* cut() { return cut_ ? &*cut_ : nullptr; }
  const CutCells* cut() const { return cut_ ? &*cut_ : nullptr; }

  // --- checkpoints
  /// Nodes, and what follows from the past: cells that wait for fluid; apertures of lips; the last window's velocities.
  void save(const Saved& to) const;
  /// Instead of the first begin(): surface as it was given to the last begin() before save().
  void restore(const Restored& from, const coupling::WetSurface& surface);

 private:
  void rescan(const std::vector<Vec3>* x_before);
  void place_probes();
  Vec3 area_at_middle(int32_t face) const;
  size_t block_number(const Index3& cell) const;

  Lattice lattice_;
  GhostRules rules_;
  std::array<int, 3> block_, blocks_;
  double p_ref_;
  WallOptions options_;
  std::optional<CutCells> cut_;
  FaceForces face_forces_;
  bool placed_ = false, probes_current_ = false;
  coupling::WetSurface surface_;  ///< with the walls' own x
  std::vector<Vec3> sent_x_;      ///< of the surface as given; conservative loads only
  std::vector<Vec3> v_last_;      ///< of the last window, by node of surface_; empty: unknown or not wanted
  double dt_ = 0, dt_last_ = 0;
  coupling::NodePlaces places_;
  Lips lips_;
  CutMap map_, map_now_;  ///< the latter: room for the next
  Changes changes_;
  std::vector<Probe> probes_;        ///< by block, then face
  std::vector<size_t> first_probe_;  ///< [block] into probes_
  std::vector<double> values_;
  Vec3 lip_force_;
  std::unordered_map<int64_t, double> first_aperture_;  ///< face_id of a lip -> aperture when it first saw fluid
};

}  // namespace bw::cfd
