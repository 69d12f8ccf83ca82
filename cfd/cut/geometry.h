// SPDX-License-Identifier: Apache-2.0
// What closed walls leave of the cells of a lattice at one time: open volume, centroid, open part of each cell face and
// the facets of the wall inside. Every triangle is split along the grid planes; all else are sums, by the theorem of
// Gauss, along columns of cells:
//   A(i + 1/2) = A(i - 1/2) - sum of the facets' area along the column,
// so a cell's faces and facets close it to round-off, whatever the surface looks like.
#pragma once
#include <cstdint>
#include <vector>

#include "cfd/embed/lattice.h"
#include "coupling/surface.h"

namespace bw::cfd {

/// A part of the wall inside one cell. Places are in cell sizes from the cell's lower corner.
struct CutFacet {
  int32_t face = -1;  ///< index into WetSurface::quads
  Vec3 area;          ///< out of the fluid; component d in areas of the cell's face across d
  Vec3 at;            ///< its centroid
  Vec3 v;             ///< m/s, velocity of the wall there
};

/// A cell with facets. Places as in CutFacet.
struct CutVolume {
  Index3 cell{};
  double volume = 0;            ///< open part of the cell
  Vec3 centroid;                ///< of that part
  double open[3][2]{};          ///< [d][upper] open part of the cell's face
  Vec3 face_at[3][2]{};         ///< centroids of these parts
  Vec3 area;                    ///< sum over the facets
  int32_t first = 0, last = 0;  ///< [first, last) of facets()
};

class CutGeometry {
 public:
  /// Nodes of the surface are at x and move with v [n_nodes]. PhysicsError if the surface is not closed or bodies
  /// overlap.
  void build(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
             const Lattice& lattice);
  /// By k, j, i.
  const std::vector<CutVolume>& cells() const { return cells_; }
  const std::vector<CutFacet>& facets() const { return facets_; }
  /// nullptr: no facets in this cell.
  const CutVolume* find(const Index3& cell) const;
  /// Is a cell without facets open?
  bool open(const Index3& cell) const;

 private:
  struct Place {
    int64_t key;  ///< of the cell in columns along d
    int32_t cell;
  };
  int64_t key(const Index3& c, int d) const;
  void march(int d, std::vector<CutVolume>& all);

  Lattice lattice_;
  double outside_ = 1;  ///< is what lies far away open?
  std::vector<CutVolume> cells_;
  std::vector<CutFacet> facets_;
  std::vector<Place> column_[3];  ///< [d] cells with facets and faces beyond the lattice, along d
  std::vector<CutVolume> all_;    ///< cells_ and those beyond the lattice
};

}  // namespace bw::cfd
