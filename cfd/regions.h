// SPDX-License-Identifier: Apache-2.0
// Shapes of initial regions. distance(x) < 0 inside [m]; its size is never above the true distance, so cells further
// from the edge than half their diagonal need no sampling.
#pragma once
#include <algorithm>
#include <cmath>
#include <variant>

#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw::cfd {

struct EverywhereRegion {
  static constexpr auto name = "everywhere";
  template <class K>
  void describe(K&) {}
  double distance(const Vec3&) const { return -1e300; }
};

struct BoxRegion {
  static constexpr auto name = "box";
  Vec3 lower, upper;
  template <class K>
  void describe(K& k) {
    k.required("lower", lower, dim::length, "corner of least coordinates");
    k.required("upper", upper, dim::length, "opposite corner");
    k.expect(upper.x > lower.x && upper.y > lower.y && upper.z > lower.z, "upper", "a point above lower in x, y and z");
  }
  double distance(const Vec3& x) const {
    double most = -1e300;
    for (int d = 0; d < 3; ++d) most = std::max({most, lower[d] - x[d], x[d] - upper[d]});
    return most;
  }
};

struct SphereRegion {
  static constexpr auto name = "sphere";
  Vec3 centre;
  double radius = 0;
  template <class K>
  void describe(K& k) {
    k.required("centre", centre, dim::length, "centre");
    k.required("radius", radius, dim::length, "radius");
    k.expect(radius > 0, "radius", "a positive length");
  }
  double distance(const Vec3& x) const { return norm(x - centre) - radius; }
};

struct CylinderRegion {
  static constexpr auto name = "cylinder";
  Vec3 start, end;
  double radius = 0;
  template <class K>
  void describe(K& k) {
    k.required("start", start, dim::length, "centre of one end");
    k.required("end", end, dim::length, "centre of the other end");
    k.required("radius", radius, dim::length, "radius");
    k.expect(radius > 0, "radius", "a positive length");
    k.expect(norm(end - start) > 0, "end", "a point apart from start");
  }
  double distance(const Vec3& x) const {
    const Vec3 axis = unit(end - start);
    const double z = dot(x - start, axis);
    return std::max({norm(x - start - z * axis) - radius, -z, z - norm(end - start)});
  }
};

struct HalfSpaceRegion {
  static constexpr auto name = "half_space";
  Vec3 point, normal{1, 0, 0};
  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "a point of its boundary");
    k.required("normal", normal, dim::none, "direction into it");
    k.expect(norm(normal) > 0, "normal", "a direction");
  }
  double distance(const Vec3& x) const { return dot(point - x, unit(normal)); }
};

/// The cells that a seed point reaches inside the surface of the bodies; whole cells, whose walls are the surface.
struct CavityRegion {
  static constexpr auto name = "cavity";
  Vec3 seed;
  template <class K>
  void describe(K& k) {
    k.required("seed", seed, dim::length, "a point inside the closed surface of a body (given here or by the solid)");
  }
};

using RegionShape =
    std::variant<EverywhereRegion, BoxRegion, SphereRegion, CylinderRegion, HalfSpaceRegion, CavityRegion>;

}  // namespace bw::cfd
