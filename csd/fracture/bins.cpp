// SPDX-License-Identifier: Apache-2.0
#include "csd/fracture/bins.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace bw::csd {

using std::numbers::pi;

namespace {

Vec3 centre_of(const HexCorners& c) {
  Vec3 sum;
  for (const Vec3& x : c) sum += 0.125 * x;
  return sum;
}

}  // namespace

AxisFrame::AxisFrame(const Vec3& axis, const Vec3& point) : axis_(unit(axis)), point_(point) {
  const Vec3 rough = std::abs(axis_.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  across_ = unit(rough - dot(rough, axis_) * axis_);
  other_ = cross(axis_, across_);
}

double AxisFrame::turns(const Vec3& x) const {
  const double angle = std::atan2(dot(x - point_, other_), dot(x - point_, across_)) / (2 * pi);
  return angle < 0 ? angle + 1 : angle;
}

double AxisFrame::extent(const HexCorners& c) const {
  double lower = along(c[0]), upper = lower;
  for (const Vec3& x : c) lower = std::min(lower, along(x)), upper = std::max(upper, along(x));
  return upper - lower;
}

double AxisFrame::angle(const HexCorners& c) const {
  const double middle = turns(centre_of(c));
  double lower = 0, upper = 0;
  for (const Vec3& x : c) {
    const double to = std::remainder(turns(x) - middle, 1.0);
    lower = std::min(lower, to), upper = std::max(upper, to);
  }
  return 2 * pi * (upper - lower);
}

BinShape measure(const Mesh& mesh, const AxisFrame& frame, const Field<double, ElemId>& volume,
                 std::span<const ElemId> elems) {
  BinShape s;
  double sum = 0, z = 0;
  for (const ElemId e : elems) {
    const HexCorners c = corners(mesh.hex[e], mesh.X);
    const Vec3 x = centre_of(c);
    sum += volume[e], z += volume[e] * frame.along(x), s.radius += volume[e] * norm(frame.away(x)),
        s.angle += volume[e] * frame.angle(c);
  }
  z /= sum, s.radius /= sum, s.angle /= sum;
  double zz = 0, zr = 0;
  for (const ElemId e : elems) {
    const Vec3 x = centre_of(corners(mesh.hex[e], mesh.X));
    const double dz = frame.along(x) - z;
    zz += volume[e] * dz * dz, zr += volume[e] * dz * (norm(frame.away(x)) - s.radius);
  }
  s.slope = zz > 0 ? zr / zz : 0;
  double inner = 1e300, outer = -1e300;
  for (const ElemId e : elems) {
    double lower = 1e300, upper = -1e300;
    for (const Vec3& x : corners(mesh.hex[e], mesh.X)) {
      const double r = norm(frame.away(x)) - s.slope * frame.along(x);
      lower = std::min(lower, r), upper = std::max(upper, r);
    }
    inner = std::min(inner, lower), outer = std::max(outer, upper);
    s.depth += volume[e] / sum * (upper - lower);
  }
  s.inner = inner, s.thickness = outer - inner;
  return s;
}

int layers(double wall, double element, double thickness) {
  if (wall <= 2 * thickness) return 1;
  return std::max(1, std::min(int(std::lround(wall / thickness)), int(std::lround(wall / element))));
}

void assign_bins(const Mesh& mesh, const AxisFrame& frame, const BinShape& shape, int around, int layers, double phase,
                 int32_t first, std::span<const ElemId> elems, Field<int32_t, ElemId>& bin) {
  for (const ElemId e : elems) {
    const Vec3 x = centre_of(corners(mesh.hex[e], mesh.X));
    const int k = int(std::floor(frame.turns(x) * around + phase)) % around;
    const double depth = norm(frame.away(x)) - shape.slope * frame.along(x) - shape.inner;
    const int layer = std::clamp(int(depth / shape.thickness * layers), 0, layers - 1);
    bin[e] = first + layer * around + k;
  }
}

int number_densely(std::span<const ElemId> elems, int32_t first, Field<int32_t, ElemId>& bin) {
  std::vector<int32_t> used;
  for (const ElemId e : elems) used.push_back(bin[e]);
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const ElemId e : elems)
    bin[e] = first + int32_t(std::lower_bound(used.begin(), used.end(), bin[e]) - used.begin());
  return int(used.size());
}

}  // namespace bw::csd
