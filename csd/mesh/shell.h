// SPDX-License-Identifier: Apache-2.0
// Closed shells of revolution: hexahedra between an inner and an outer profile, the poles covered by butterfly discs.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "common/math/units.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Half of a section through the axis.
struct ProfilePoint {
  double z = 0, r = 0;
};

/// Matching points of the inner and the outer profile, from the lower pole (r = 0) to the upper one.
struct Profile {
  std::vector<ProfilePoint> inner, outer;  ///< equally many
  std::vector<bool> is_mark;               ///< a ring of nodes goes exactly through this point (a corner)
};
/// Volume of the body of revolution under a profile [m^3], exact for its straight pieces.
double revolved_volume(const std::vector<ProfilePoint>& profile);

struct ShellCount {
  int around = 32;          ///< elements around, a multiple of 8
  int through = 2;          ///< elements through the wall
  double element_size = 0;  ///< length of elements along the profile; 0: as around the widest place
  bool is_split = false;    ///< each hex through six tetrahedra into 24 hexes
};
/// Hexes between the profiles about the z axis; face and node sets inner and outer.
Mesh loft(const Profile& profile, const ShellCount& count);

/// Profiles as the user's own points; corners are kept (turns of more than 20 degrees).
struct PointsProfile {
  std::vector<double> outer_z, outer_r, inner_z, inner_r;
  static constexpr auto name = "points";
  template <class K>
  void describe(K& k) {
    k.required("outer_z", outer_z, dim::length, "z of the outer profile, from the lower pole to the upper");
    k.required("outer_r", outer_r, dim::length, "r of the same points; 0 at both ends");
    k.required("inner_z", inner_z, dim::length,
               "z of the cavity's profile; as many points are matched one by one, else by arc length");
    k.required("inner_r", inner_r, dim::length, "r of the same points; 0 at both ends");
    const auto is_profile = [](const std::vector<double>& z, const std::vector<double>& r) {
      bool is_positive = z.size() == r.size() && r.size() >= 3;
      for (size_t i = 1; is_positive && i + 1 < r.size(); ++i) is_positive = r[i] > 0;
      return is_positive && r.front() == 0 && r.back() == 0 && z.back() > z.front();
    };
    k.expect(is_profile(outer_z, outer_r), "outer_r",
             "as many values as outer_z, at least 3, 0 at both ends and positive between, z rising");
    k.expect(is_profile(inner_z, inner_r), "inner_r",
             "as many values as inner_z, at least 3, 0 at both ends and positive between, z rising");
  }
  Profile make() const;
};
struct SphereProfile {
  double radius = 0, wall = 0;
  static constexpr auto name = "sphere";
  template <class K>
  void describe(K& k) {
    k.required("radius", radius, dim::length, "outer radius; the centre is the origin");
    k.required("wall", wall, dim::length, "wall thickness");
    k.expect(wall > 0 && wall < radius, "wall", "between 0 and the radius");
  }
  Profile make() const;
};
/// A cylinder closed by flat ends ("can") or half spheres ("capsule"), from z = 0 to its length.
struct CanProfile {
  double radius = 0, length = 0, wall = 0, lower_wall = 0, upper_wall = 0;
  static constexpr auto name = "can";
  template <class K>
  void describe(K& k) {
    k.required("radius", radius, dim::length, "outer radius");
    k.required("length", length, dim::length, "outer length, from z = 0");
    k.required("wall", wall, dim::length, "thickness of the side");
    k.expect(wall > 0 && wall < radius, "wall", "between 0 and the radius");
    lower_wall = upper_wall = wall;
    k.optional("lower_wall", lower_wall, dim::length, "thickness of the lower end (default: wall)");
    k.optional("upper_wall", upper_wall, dim::length, "thickness of the upper end (default: wall)");
    k.expect(lower_wall > 0 && upper_wall > 0 && lower_wall + upper_wall < length, "length",
             "more than both ends' thickness");
  }
  Profile make() const;
};
struct CapsuleProfile {
  double radius = 0, length = 0, wall = 0;
  static constexpr auto name = "capsule";
  template <class K>
  void describe(K& k) {
    k.required("radius", radius, dim::length, "outer radius");
    k.required("length", length, dim::length, "outer length with both half spheres, from z = 0");
    k.required("wall", wall, dim::length, "wall thickness");
    k.expect(wall > 0 && wall < radius, "wall", "between 0 and the radius");
    k.expect(length > 2 * radius, "length", "more than twice the radius");
  }
  Profile make() const;
};
using ProfileShape = std::variant<PointsProfile, SphereProfile, CanProfile, CapsuleProfile>;

/// Sets of nodes and faces: inner (the cavity's wall) and outer.
struct ShellOfRevolution {
  ProfileShape shape;
  ShellCount count;
  std::string axis = "z";
  Vec3 base{0, 0, 0};
  static constexpr auto name = "shell_of_revolution";
  template <class K>
  void describe(K& k) {
    k.pick("shape", shape, "the profiles", true);
    k.required("around", count.around, "elements around the axis, a multiple of 8");
    k.expect(count.around >= 8 && count.around % 8 == 0, "around", "a multiple of 8");
    k.required("through", count.through, "elements through the wall");
    k.expect(count.through >= 1, "through", "at least 1");
    k.optional("element_size", count.element_size, dim::length,
               "length of elements along the profile; 0: as around the widest place");
    k.expect(count.element_size >= 0, "element_size", "0 or a positive length");
    k.optional("split", count.is_split, "each hex through six tetrahedra into 24 hexes");
    k.choice("axis", axis, {"x", "y", "z"}, "direction of the axis");
    k.optional("base", base, dim::length, "where the profile's z = 0, r = 0 lies");
  }
  Mesh make() const;
};

/// The generic 500-lb-class body (VALIDATION B): axis z, nose up, base at z = 0. Boat-tail, cylinder, blunted tangent
/// ogive; the wall thickens into a solid nose plug. Sets: inner, outer; element sets nose_plug and base_plug (metal
/// above and below the cavity), wall (the rest).
struct Weapon {
  std::string size = "demo";
  double length = 1.5, diameter = 0.273, wall = 0.012, nose_length = 0.52, nose_radius = 0.045, nose_plug = 0.06,
         tail_length = 0.35, tail_diameter = 0.21, tail_wall = 0.022, base_plug = 0.04;
  int around = 0, through = 0;
  bool is_split = false;
  static constexpr auto name = "weapon";
  template <class K>
  void describe(K& k) {
    k.choice("size", size, {"demo", "paper", "fine"}, "about 10 thousand, 100 thousand or 400 thousand elements");
    k.optional("length", length, dim::length, "from base to nose");
    k.optional("diameter", diameter, dim::length, "outer diameter of the cylinder");
    k.optional("wall", wall, dim::length, "thickness of the cylinder's wall");
    k.optional("nose_length", nose_length, dim::length, "length of the blunted tangent ogive");
    k.optional("nose_radius", nose_radius, dim::length, "radius of the nose's sphere");
    k.optional("nose_plug", nose_plug, dim::length, "thickness of the solid nose along the axis");
    k.optional("tail_length", tail_length, dim::length, "length of the boat-tail");
    k.optional("tail_diameter", tail_diameter, dim::length, "outer diameter of the base");
    k.optional("tail_wall", tail_wall, dim::length,
               "thickness of the boat-tail at the base; `wall` where it meets the cylinder");
    k.optional("base_plug", base_plug, dim::length, "thickness of the base");
    k.optional("around", around, "elements around, a multiple of 8; 0: by size");
    k.optional("through", through, "elements through the wall; 0: by size");
    k.optional("split", is_split,
               "each hex through six tetrahedra into 24 hexes (give `around` and `through` for coarser ones)");
    k.expect(wall > 0 && 2 * wall < diameter, "wall", "between 0 and half the diameter");
    k.expect(tail_wall > 0 && 2 * tail_wall < tail_diameter && tail_diameter <= diameter, "tail_diameter",
             "between 2 tail_wall and the diameter");
    k.expect(nose_radius > 0 && 2 * nose_radius < diameter && nose_radius < nose_length, "nose_radius",
             "less than half the diameter and the nose");
    k.expect(base_plug > 0 && base_plug < tail_length, "base_plug", "between 0 and the tail's length");
    k.expect(nose_plug > 0 && nose_plug < 0.5 * nose_length, "nose_plug", "between 0 and half the nose's length");
    k.expect(tail_length + nose_length < length, "length", "more than tail and nose together");
    k.expect(around == 0 || (around >= 16 && around % 8 == 0), "around", "0 or a multiple of 8 from 16");
    k.expect(through >= 0, "through", "0 or more");
  }
  Profile profile() const;
  Mesh make() const;
};

}  // namespace bw::csd
