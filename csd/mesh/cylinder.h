// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "common/math/units.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// What all round bodies have.
struct RoundAlongAxis {
  double length = 0, grading = 1;
  int along = 8;
  std::string axis = "z", sector = "full";
  Vec3 base{0, 0, 0};
  bool is_split = false;

  template <class K>
  void describe_length(K& k) {
    k.required("length", length, dim::length, "length along the axis");
    k.expect(length > 0, "length", "a positive length");
  }
  template <class K>
  void describe_rest(K& k) {
    k.required("along", along, "elements along the axis");
    k.expect(along >= 1, "along", "at least 1");
    k.optional("grading", grading, dim::none, "length of the last element along the axis over the first");
    k.expect(grading > 0, "grading", "a positive ratio");
    k.choice("axis", axis, {"x", "y", "z"}, "direction of the axis");
    k.optional("base", base, dim::length, "centre of the lower end");
    k.choice("sector", sector, {"full", "half", "quarter"},
             "part of the cross-section, between symmetry planes through the axis");
    k.optional("split", is_split, "each hex through six tetrahedra into 24 hexes");
  }
};

/// A solid cylinder (or frustum) with a butterfly cross-section. Sets of nodes and faces: lower, upper (ends), side;
/// cut_x, cut_y, cut_z: the planes of a half or quarter, by the direction of their normal.
struct Cylinder : RoundAlongAxis {
  double radius = 0, upper_radius = 0;
  int across = 4;
  static constexpr auto name = "cylinder";
  template <class K>
  void describe(K& k) {
    k.required("radius", radius, dim::length, "radius at the base");
    k.expect(radius > 0, "radius", "a positive length");
    upper_radius = radius;
    k.optional("upper_radius", upper_radius, dim::length, "radius at the other end (default: the same)");
    k.expect(upper_radius > 0, "upper_radius", "a positive length");
    describe_length(k);
    k.required("across", across, "elements across the radius, at least 2");
    k.expect(across >= 2, "across", "at least 2");
    describe_rest(k);
    k.expect(3.0 * across * across * along <= most_elements, "across", few_enough);
  }
  Mesh make() const;
};

/// A hollow cylinder or ring. Sets of nodes and faces: inner, outer, lower, upper; cut_x, cut_y, cut_z as for the
/// cylinder.
struct Tube : RoundAlongAxis {
  double inner_radius = 0, outer_radius = 0;
  int around = 32, through = 2;
  static constexpr auto name = "tube";
  template <class K>
  void describe(K& k) {
    k.required("inner_radius", inner_radius, dim::length, "radius of the bore");
    k.expect(inner_radius > 0, "inner_radius", "a positive length");
    k.required("outer_radius", outer_radius, dim::length, "outer radius");
    k.expect(outer_radius > inner_radius, "outer_radius", "more than inner_radius");
    describe_length(k);
    k.required("around", around, "elements around the full circle, also for a sector");
    k.required("through", through, "elements through the wall");
    k.expect(through >= 1, "through", "at least 1");
    describe_rest(k);
    k.expect(around >= 4 && (sector == "full" || around % 4 == 0), "around",
             "at least 4; a multiple of 4 for a sector");
    k.expect(0.25 * around * through * along <= most_elements, "around", few_enough);
  }
  Mesh make() const;
};

}  // namespace bw::csd
