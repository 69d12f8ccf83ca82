// SPDX-License-Identifier: Apache-2.0
// Moving cut cells (treatment = "cut_cell"): volumes, neighbourhoods and the conservative end of a step. A step:
//
//   cells.begin(surface, x, v, x_end, dt);   // geometry at its begin, middle and end
//   each block with cells.near(...):         // any order, any thread, any rank
//     CutCellKernel: fluxes through the open cell faces, pressures on the facets; content of each listed cell
//   cells.mix(comm);                         // small cells with their neighbours: new states of listed cells
//   cells.commit();                          // the step counts
//
// The volume of a cell is what the geometric conservation law makes of it: it grows by the volume that its facets sweep
// at mid-step, V1 = V0 + dt sum(v . area), so that gas which moves with the walls stays as it is to round-off. What
// that lacks of the true volume of a cell that closes, or is open again, goes to a cut cell beside it with the
// gas in it.
// Cells of less than half a cell are stabilised by state redistribution [Berger, Giuliani 2021, J. Comput. Phys. 428]
// over neighbourhoods along the wall's normal.
// Every rank holds all listed cells and gets the same bits.
#pragma once
#include <array>
#include <functional>
#include <unordered_map>

#include "cfd/cut/geometry.h"
#include "cfd/embed/patch_cuts.h"
#include "cfd/scheme/hllc.h"
#include "common/io/checkpoint.h"
#include "common/parallel/mpi.h"

namespace bw::cfd {

/// A listed cell: cut at some time of the step, or next to one that is. Volumes are parts of a whole cell.
struct CutCell {
  Index3 cell{};
  bool cut = false;                ///< at some time of the step, or of another volume than its geometry's
  bool open_mid = true;            ///< without facets at mid-step: open?
  double volume0 = 1;              ///< part of the cell that holds gas, at the step's begin
  double volume1 = 1;              ///< and at its end
  Vec3 centroid0, centroid1;       ///< in cell sizes from the lower corner
  const CutVolume* mid = nullptr;  ///< geometry at mid-step; nullptr: no facets
  double volume_end = 1;           ///< of the geometry, at the end
  Vec3 inward;                     ///< into the fluid at the end; zero: no facets
};

class CutCells {
 public:
  /// block: cells per block and direction; periodic: by direction.
  CutCells(const Lattice& lattice, const GhostRules& rules, const Index3& block);

  /// The walls stand at x, before the first step. Volumes are the geometry's, or those restored.
  void place(const coupling::WetSurface& surface, const std::vector<Vec3>& x);
  /// They go from x to x_end in a step of dt [n_nodes].
  void begin(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
             const std::vector<Vec3>& x_end, double dt);
  const std::vector<CutCell>& cells() const { return list_; }
  const std::vector<CutFacet>& facets() const { return mid_.facets(); }
  /// Of a cell with index -2 .. n + 1 in each direction: place in cells(); -1: not listed, -2: beyond the domain.
  int find(Index3 cell) const;
  /// Is a cell of these, listed ones excepted, without gas?
  bool closed(Index3 cell) const { return wrap(cell) && !begin_.open(cell); }
  /// Part of a cell that holds gas, as of the last commit() (or the first begin()).
  double volume(const Index3& cell) const;
  /// Can walls matter to the block with this first cell? Else all of it is open, or closed.
  bool near(const Index3& first_cell) const { return near_[block_number(first_cell)]; }

  /// What the kernel found, [place in cells()]: integral of U over the cell, over the cell's volume; slopes of U over a
  /// cell size.
  struct Content {
    double U[GasCons::count];
    double slope[3][GasCons::count];
  };
  std::vector<Content>& contents() { return contents_; }
  /// Means over the open volumes at the end of the step, from contents() of all ranks. usable(U): is it a gas?
  void mix(const Comm& comm, const std::function<bool(const double*)>& usable);
  /// The result of mix().
  const double* mean(size_t place) const { return means_[place].data(); }
  void commit();

  void save(const Saved& to) const;
  /// Instead of what the first begin() would find.
  void restore(const Restored& from);

 private:
  using Mean = std::array<double, GasCons::count>;
  int64_t key(const Index3& c) const { return (int64_t(c[2]) * lattice_.n[1] + c[1]) * lattice_.n[0] + c[0]; }
  size_t block_number(const Index3& c) const {
    return (size_t(c[2] / block_[2]) * size_t(blocks_[1]) + size_t(c[1] / block_[1])) * size_t(blocks_[0]) +
           size_t(c[0] / block_[0]);
  }
  bool wrap(Index3& c) const;
  void list();
  void add(const Index3& cell, bool cut);
  void check_room(const CutGeometry& g) const;
  void settle();
  void choose_groups();
  void redistribute(const std::vector<Content>& all, const std::function<bool(const double*)>& usable);
  /// visit(cell, offset) for the cells around one, in used directions.
  template <class Visit>
  void for_each_around(const Index3& cell, const Visit& visit) const;

  Lattice lattice_;
  GhostRules rules_;
  Index3 block_, blocks_;
  bool still_ = false;  ///< in this step
  double dt_ = 0;
  std::vector<Vec3> x_, x_end_;
  CutGeometry begin_, mid_, end_;
  std::unordered_map<int64_t, double> volumes_;  ///< of cells that are neither whole nor closed
  std::vector<CutCell> list_;
  std::unordered_map<int64_t, int32_t> place_;
  std::vector<uint8_t> near_;  ///< [block]
  std::vector<uint8_t> row_;   ///< [k][j] does a row along x hold listed cells?
  std::vector<Content> contents_;
  std::vector<Mean> inside_, means_;  ///< [place] integrals over the cells' volume, means of U
  struct Member {
    int32_t place;
    Vec3 offset;  ///< in cells
  };
  std::vector<std::vector<Member>> groups_;  ///< neighbourhoods of small cells, they themselves first
  std::vector<int32_t> groups_with_;  ///< [place] how many neighbourhoods a cell is in, its own whole one included
};

}  // namespace bw::cfd
