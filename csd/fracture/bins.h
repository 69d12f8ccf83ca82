// SPDX-License-Identifier: Apache-2.0
// Bins of a ring of elements by angle and, on request, by depth in the wall (VALIDATION C.6, C.8).
#pragma once
#include <span>

#include "csd/mesh/hex.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Cylindrical coordinates about the weapon's axis.
class AxisFrame {
 public:
  AxisFrame(const Vec3& axis, const Vec3& point);
  double along(const Vec3& x) const { return dot(x - point_, axis_); }
  /// Away from the axis, not normalised.
  Vec3 away(const Vec3& x) const { return x - point_ - along(x) * axis_; }
  double turns(const Vec3& x) const;  ///< angle, 0 to 1
  /// Extent of an element along the axis [m].
  double extent(const HexCorners& c) const;
  /// Extent around the axis [rad].
  double angle(const HexCorners& c) const;

 private:
  Vec3 axis_, point_, across_, other_;
};

/// Means of a ring's elements in the reference configuration, weighted by volume, and its wall.
struct BinShape {
  double radius = 0;            ///< m
  double angle = 0;             ///< rad, extent of an element around the axis
  double depth = 0;             ///< m, extent of an element through the wall
  double thickness = 0;         ///< m, of the wall
  double slope = 0, inner = 0;  ///< the inner face lies at radius inner + slope z
};
BinShape measure(const Mesh& mesh, const AxisFrame& frame, const Field<double, ElemId>& volume,
                 std::span<const ElemId> elems);

/// Layers of a wall for pieces of a thickness; 1 unless it is thicker than two of them, never more than it has
/// elements.
int layers(double wall, double element, double thickness);

/// bin [element] = first + layer * around + angle for the elements given; phase in turns of a bin.
void assign_bins(const Mesh& mesh, const AxisFrame& frame, const BinShape& shape, int around, int layers, double phase,
                 int32_t first, std::span<const ElemId> elems, Field<int32_t, ElemId>& bin);

/// Bins of the elements become first, first + 1, ... without gaps, in their order. Returns how many there are.
int number_densely(std::span<const ElemId> elems, int32_t first, Field<int32_t, ElemId>& bin);

}  // namespace bw::csd
