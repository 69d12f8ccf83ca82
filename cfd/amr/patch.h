// SPDX-License-Identifier: Apache-2.0
// The working copy of one block: primitive variables with two layers of neighbours, filled by cfd/amr/gather.h, read by
// the kernels.
//   (variable, k, j, i) -> row(variable, k, j)[i],  i, j, k from -ghost(d) to n(d) + ghost(d) - 1.
// A direction with one cell in the whole domain is unused: no ghosts, no fluxes.
#pragma once
#include <array>
#include <cstddef>

#include "cfd/mix/five_equation.h"
#include "common/data/field.h"
#include "common/math/tensor.h"

namespace bw::cfd {

inline constexpr int ghost_layers = 2;

/// What a row of cells stands for: slabs, shells of a cylinder of height h.z, or shells of a whole sphere. In the
/// latter two x is the radius, the only direction that is used.
enum class Geometry { planar, cylindrical, spherical };

/// Area of the cylinder (per height) or sphere of radius r; 1 where planar.
inline double area_at(Geometry g, double r) {
  constexpr double pi = 3.14159265358979323846;
  return g == Geometry::spherical ? 4 * pi * r * r : g == Geometry::cylindrical ? 2 * pi * r : 1;
}

/// Cells of one block and of its storage. The same for all blocks of a run, but for the cell size of their level.
struct BlockShape {
  std::array<int, 3> n{1, 1, 1};                  ///< cells per direction
  std::array<bool, 3> used{false, false, false};  ///< false: the domain has one cell in this direction
  Vec3 h{1, 1, 1};                                ///< cell size [m]
  int cells() const { return n[0] * n[1] * n[2]; }
  int ghost(int d) const { return used[d] ? ghost_layers : 0; }
  /// Place of (k, j, i) in the storage of one variable.
  size_t at(int k, int j, int i) const { return (size_t(k) * n[1] + j) * n[0] + i; }
  Geometry geometry = Geometry::planar;
  bool radial() const { return geometry != Geometry::planar; }
  /// [m^3] of every cell; planar.
  double cell_volume() const { return h.x * h.y * h.z; }
  /// [m^3] of a cell with place i along x of a block that begins at lower_x.
  double cell_volume(double lower_x, int i) const {
    if (!radial()) return cell_volume();
    const double m =
        lower_x + (i + 0.5) * h.x;  // the shell's mean area is that at its middle, and for a sphere a bit more
    const double more = geometry == Geometry::spherical ? area_at(geometry, h.x) / 12 : 0;
    return (area_at(geometry, m) + more) * h.x * (geometry == Geometry::cylindrical ? h.z : 1);
  }
  /// h times the area of one face of a side in direction d of a block that begins at lower_x: what a flux dt/h takes
  /// from the domain there [m^3].
  double side_volume(double lower_x, int d, bool upper) const {
    if (!radial()) return cell_volume();
    const double r = lower_x + (d == 0 && upper ? n[0] * h.x : 0.0);
    return area_at(geometry, r) * h.x * (geometry == Geometry::cylindrical ? h.z : 1);
  }
};

/// Distance in doubles between arrays that are walked side by side, at least n: multiples of a page would make them
/// fight for the same lines of the first cache.
inline size_t spread(size_t n) { return (n + 455) / 512 * 512 + 56; }

class Patch {
 public:
  Patch() = default;
  explicit Patch(const BlockShape& shape, int materials = 2) : shape_(shape) {
    pitch_ = (margin + shape.n[0] + margin_right + 7) / 8 * 8;
    rows_j_ = shape.n[1] + 2 * shape.ghost(1);
    rows_k_ = shape.n[2] + 2 * shape.ghost(2);
    stride_ = spread(size_t(pitch_) * rows_j_ * rows_k_);
    data_.assign(stride_ * size_t(Prim::rows(materials)), 0.0);
  }
  const BlockShape& shape() const { return shape_; }
  void set_cell_size(const Vec3& h) { shape_.h = h; }
  /// Pointer to cell (k, j, i = 0) of a Prim row. Packs may be loaded from i = -margin to i = n(0) + margin_right - 1.
  double* row(int variable, int k, int j) { return data_.data() + offset(variable, k, j); }
  const double* row(int variable, int k, int j) const { return data_.data() + offset(variable, k, j); }
  ptrdiff_t stride_j() const { return pitch_; }
  ptrdiff_t stride_k() const { return ptrdiff_t(pitch_) * rows_j_; }
  ptrdiff_t stride_variable() const { return ptrdiff_t(stride_); }
  int pitch() const { return pitch_; }

  static constexpr int margin = 4;         ///< doubles before i = 0
  static constexpr int margin_right = 10;  ///< doubles from i = n on: two ghosts, and packs that hang over

  bool whole = false;    ///< in: all ghosts are wanted; else those alone that the block kernel's and samplers' stencils meet
  int block = -1;        ///< local index of the block (cfd/amr/forest.h)
  Vec3 lower;            ///< its lower corner [m]; centre of cell i: lower + (i + 1/2) h
  bool burns = false;    ///< row Prim::stored_energy is filled
  bool limited = false;  ///< row Prim::order is filled
  bool shocked = false;  ///< row Prim::shock is filled
  int material = 0;  ///< 1, 2 ...: open cells of the block and all ghosts hold this material alone (alpha exactly 1 or 0); 0: mixed

 private:
  size_t offset(int variable, int k, int j) const {
    return stride_ * size_t(variable) + (size_t(k + shape_.ghost(2)) * rows_j_ + size_t(j + shape_.ghost(1))) * pitch_ +
           margin;
  }
  BlockShape shape_;
  int pitch_ = 0, rows_j_ = 0, rows_k_ = 0;
  size_t stride_ = 0;
  Aligned<double> data_;
};

}  // namespace bw::cfd
