// SPDX-License-Identifier: Apache-2.0
// Shapes of stand-alone bodies ([[fluid.body]]) as surfaces of quads, normals into the fluid.
#pragma once
#include <array>
#include <string>
#include <variant>
#include <vector>

#include "cfd/embed/lattice.h"
#include "common/math/units.h"
#include "coupling/surface.h"

namespace bw::cfd {

/// What a shape needs of the grid: facets of about a cell, planes that reach beyond the domain.
struct ShapeSetting {
  Vec3 lower, upper;  ///< of the domain [m]
  double h = 0;       ///< facet size wanted [m]
  std::array<bool, 3> active{true, true, true};  ///< directions with more than one cell
  double far() const { return 2 * norm(upper - lower); }
};
/// x and quads of a surface; nothing else is filled by shapes.
using Facets = coupling::WetSurface;

struct BoxShape {
  static constexpr auto name = "box";
  Vec3 lower, upper;
  template <class K>
  void describe(K& k) {
    k.required("lower", lower, dim::length, "corner of least coordinates");
    k.required("upper", upper, dim::length, "opposite corner");
    k.expect(upper.x > lower.x && upper.y > lower.y && upper.z > lower.z, "upper", "a point above lower in x, y and z");
  }
  Facets facets(const ShapeSetting& s) const;
};

struct SphereShape {
  static constexpr auto name = "sphere";
  Vec3 centre;
  double radius = 0;
  template <class K>
  void describe(K& k) {
    k.required("centre", centre, dim::length, "centre");
    k.required("radius", radius, dim::length, "radius");
    k.expect(radius > 0, "radius", "a positive length");
  }
  Facets facets(const ShapeSetting& s) const;
};

struct CylinderShape {
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
  Facets facets(const ShapeSetting& s) const;
};

/// Metal behind a plane that goes through the whole domain.
struct PistonShape {
  static constexpr auto name = "piston";
  Vec3 point, normal{1, 0, 0};
  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "a point on the piston's face");
    k.optional("normal", normal, dim::none, "direction into the fluid; all behind the face is metal");
    k.expect(norm(normal) > 0, "normal", "a direction");
  }
  Facets facets(const ShapeSetting& s) const;
};

/// A thin plate, wet on both sides.
struct PlaneShape {
  static constexpr auto name = "plane";
  Vec3 point, normal{1, 0, 0}, along{0, 0, 0};
  std::vector<double> size;
  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "centre of the plate");
    k.optional("normal", normal, dim::none, "normal of the plate");
    k.optional("size", size, dim::length, "lengths of its two edges; absent: it goes through the whole domain");
    k.optional("along", along, dim::none, "direction of the first edge; absent: any");
    k.expect(norm(normal) > 0, "normal", "a direction");
    k.expect(size.empty() || (size.size() == 2 && size[0] > 0 && size[1] > 0), "size", "two positive lengths");
    k.expect(norm(along) == 0 || norm(cross(along, normal)) > 1e-6 * norm(along) * norm(normal), "along",
             "a direction across the normal");
  }
  Facets facets(const ShapeSetting& s) const;
};

/// A polygon in x and y, extruded along z.
struct PrismShape {
  static constexpr auto name = "prism";
  std::vector<Vec3> points;
  std::vector<double> span;
  bool sides_cross() const;  ///< in their inside: hollow polygons may touch themselves
  template <class K>
  void describe(K& k) {
    k.required("points", points, dim::length, "corners of the polygon in order, [x, y, 0] each");
    k.optional("span", span, dim::length, "z of its two ends; absent: it goes through the whole domain");
    k.expect(points.size() >= 3, "points", "at least three points");
    k.expect(!sides_cross(), "points", "a polygon whose sides don't cross each other");
    k.expect(span.empty() || (span.size() == 2 && span[1] > span[0]), "span", "two lengths in order");
  }
  Facets facets(const ShapeSetting& s) const;
};

/// A ramp: triangle with its edge at `point`, floor along +x, face rising at `angle` to it; extruded along z.
struct WedgeShape {
  static constexpr auto name = "wedge";
  Vec3 point;
  double angle = 0, length = 0;
  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "a point of the leading edge");
    k.required("angle", angle, dim::none, "of its face to its floor [degrees]");
    k.required("length", length, dim::length, "of its floor, along +x");
    k.expect(angle > 0 && angle < 90, "angle", "degrees between 0 and 90");
    k.expect(length > 0, "length", "a positive length");
  }
  Facets facets(const ShapeSetting& s) const;
};

using Shape = std::variant<BoxShape, SphereShape, CylinderShape, PistonShape, PlaneShape, PrismShape, WedgeShape>;

}  // namespace bw::cfd
