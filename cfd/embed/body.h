// SPDX-License-Identifier: Apache-2.0
// Stand-alone bodies, [[fluid.body]]: a shape, where it is turned, and how it moves: as prescribed, or as the flow
// pushes it. Together they are one surface.
#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cfd/embed/rigid.h"
#include "cfd/embed/shapes.h"
#include "common/io/checkpoint.h"
#include "coupling/loads.h"

namespace bw::cfd {

struct FaceForces;

/// Rigid motion since t = 0: x(t) = point + R(axis, angle) (X - point) + shift.
struct Placement {
  Vec3 shift;
  Vec3 point, axis{0, 0, 1};
  double angle = 0;
  Vec3 operator()(const Vec3& X) const;
};

// A motion: name, describe(keys), at(t).
struct FixedMotion {
  static constexpr auto name = "fixed";
  template <class K>
  void describe(K&) {}
  Placement at(double) const { return {}; }
};
struct VelocityMotion {
  static constexpr auto name = "velocity";
  Vec3 value;
  double start = 0;
  template <class K>
  void describe(K& k) {
    k.required("value", value, dim::velocity, "velocity");
    k.optional("start", start, dim::time, "at rest before");
  }
  Placement at(double t) const { return {std::max(t - start, 0.0) * value, {}, {0, 0, 1}, 0}; }
};
/// Velocity linear between times, constant after the last.
struct TableMotion {
  static constexpr auto name = "table";
  std::vector<double> times;
  std::vector<Vec3> velocities;
  template <class K>
  void describe(K& k) {
    k.required("times", times, dim::time, "ascending");
    k.required("velocities", velocities, dim::velocity, "one per time, linear between them");
    k.expect(!times.empty() && times.size() == velocities.size(), "velocities", "as many as times");
    bool ascending = true;
    for (size_t i = 1; i < times.size(); ++i) ascending = ascending && times[i] > times[i - 1];
    k.expect(ascending, "times", "ascending times");
  }
  Placement at(double t) const;
};
/// v = velocity sin^2(pi (t - start)/duration) within the duration, else at rest.
struct PulseMotion {
  static constexpr auto name = "pulse";
  Vec3 velocity;
  double duration = 0, start = 0;
  template <class K>
  void describe(K& k) {
    k.required("velocity", velocity, dim::velocity, "largest velocity, at half the duration");
    k.required("duration", duration, dim::time, "v = velocity sin^2(pi (t - start)/duration)");
    k.optional("start", start, dim::time, "at rest before");
    k.expect(duration > 0, "duration", "a positive time");
  }
  Placement at(double t) const;
};
/// v = velocity sin(2 pi frequency t).
struct OscillationMotion {
  static constexpr auto name = "sinusoidal";
  Vec3 velocity;
  double frequency = 0;
  template <class K>
  void describe(K& k) {
    k.required("velocity", velocity, dim::velocity, "amplitude of the velocity");
    k.required("frequency", frequency, dim::frequency, "v = velocity sin(2 pi frequency t)");
    k.expect(frequency > 0, "frequency", "a positive frequency");
  }
  Placement at(double t) const;
};
struct RotationMotion {
  static constexpr auto name = "rotation";
  Vec3 point, axis{0, 0, 1}, velocity;
  double rate = 0;
  template <class K>
  void describe(K& k) {
    k.required("point", point, dim::length, "a point of the axis");
    k.required("axis", axis, dim::none, "direction of the axis");
    k.required("rate", rate, dim::spin, "radians per second");
    k.optional("velocity", velocity, dim::velocity, "of the axis");
    k.expect(norm(axis) > 0, "axis", "a direction");
  }
  Placement at(double t) const { return {t * velocity, point, axis, rate * t}; }
};
/// A rigid body that the flow's pressures move.
struct FreeMotion {
  static constexpr auto name = "free";
  double density = 0, mass = 0;
  std::vector<double> inertia;
  std::optional<Vec3> centre;
  Vec3 velocity, spin;
  bool plane = false;
  std::array<bool, 6> free{true, true, true, true, true, true};
  std::string place;
  template <class K>
  void describe(K& k) {
    k.optional("density", density, dim::density, "of the body, whose surface is closed; or mass");
    k.optional("mass", mass, dim::mass,
               "of the body (in a flow of two dimensions: of its length in the domain); or density");
    k.optional("inertia", inertia, Dim{1, 2, 0, 0},
               "moments about axes along x, y, z through its centre of mass; absent: of its surface, filled evenly");
    const double none = 1e300;
    Vec3 at{none, none, none};
    k.optional("centre", at, dim::length, "of mass, at the start; absent: of its surface, filled evenly");
    if (at.x != none) centre = at;
    k.optional("velocity", velocity, dim::velocity, "at the start");
    k.optional("spin", spin, dim::spin, "at the start, about axes along x, y, z");
    k.optional("plane", plane, "it moves along x and y and turns about z only");
    std::vector<std::string> fixed;
    k.optional("fixed", fixed, "directions in which it doesn't move: of x, y, z, turn_x, turn_y, turn_z");
    static constexpr const char* names[6] = {"x", "y", "z", "turn_x", "turn_y", "turn_z"};
    if (plane) free[2] = free[3] = free[4] = false;
    for (const std::string& f : fixed) {
      const auto i = std::find(std::begin(names), std::end(names), f) - std::begin(names);
      k.expect(i < 6, "fixed", "of \"x\", \"y\", \"z\", \"turn_x\", \"turn_y\", \"turn_z\", not \"" + f + "\"");
      if (i < 6) free[size_t(i)] = false;
    }
    k.expect(k.is_manual() || (density > 0) != (mass > 0), "density",
             "a positive density, or a positive mass, not both");
    k.expect(density >= 0 && mass >= 0, "mass", "a positive mass");
    k.expect(
        inertia.empty() || (inertia.size() == 3 && inertia[0] > 0 && inertia[1] > 0 && inertia[2] > 0 && density == 0),
        "inertia", "three positive moments, beside a mass");
    const auto sum = [&](size_t a, size_t b) { return (1 + 1e-9) * (inertia[a] + inertia[b]); };
    k.expect(inertia.size() != 3 || (inertia[0] <= sum(1, 2) && inertia[1] <= sum(2, 0) && inertia[2] <= sum(0, 1)),
             "inertia", "moments of which none is above the sum of the others");
    for (int d = 0; d < 3; ++d) {
      k.expect(free[size_t(d)] || velocity[d] == 0, "velocity", "0 in directions in which the body doesn't move");
      k.expect(free[size_t(3 + d)] || spin[d] == 0, "spin", "0 about axes about which the body doesn't turn");
    }
    place = k.is_manual() ? "" : k.where(density > 0 ? "density" : "mass");
  }
};
using Motion =
    std::variant<FixedMotion, VelocityMotion, TableMotion, PulseMotion, OscillationMotion, RotationMotion, FreeMotion>;

struct BodyCase {
  std::string name;
  Shape shape;
  Motion motion;
  bool thin = false;
  Vec3 turn_axis{0, 0, 1}, turn_point;
  double turn_angle = 0;  // degrees
  double facet = 0;

  template <class K>
  void describe(K& k) {
    k.required("name", name, "name of the body");
    Picked<Shape> s{shape, "geometry"};
    k.table("shape", s, "what it looks like");
    shape = s.value;
    Picked<Motion> m{motion, "how it moves"};
    k.table("motion", m, "prescribed motion; absent: fixed");
    motion = m.value;
    k.optional("thin", thin, "a shell without thickness: fluid on both sides of its surface (a plane always is)");
    k.optional("facet", facet, dim::length, "size of its facets; 0: a cell");
    k.optional("turn_angle", turn_angle, dim::none, "the shape is turned by this angle [degrees]");
    k.optional("turn_axis", turn_axis, dim::none, "about this axis");
    k.optional("turn_point", turn_point, dim::length, "through this point");
    k.expect(norm(turn_axis) > 0, "turn_axis", "a direction");
    k.expect(facet >= 0, "facet", "a length, zero or positive");
  }

 private:
  template <class V>
  struct Picked {
    V value;
    const char* doc;
    template <class K>
    void describe(K& k) {
      k.pick("kind", value, doc);
    }
  };
};

/// A body that the flow moves, and its faces in its own axes.
struct FreeBody {
  std::string name;
  RigidBody rigid;
  int32_t first_face, last_face;  ///< [first, last) of the surface
  std::vector<Vec3> area, lever;  ///< [face] A [m^2], sum of r x A over its triangles, r from the centre of mass [m^3]
};

/// All bodies of a case as one surface.
class Bodies {
 public:
  /// InputError for a free body without mass properties.
  Bodies(const std::vector<BodyCase>& bodies, const ShapeSetting& setting);
  bool empty() const { return surface_.quads.empty(); }
  /// Positions at t, the time to which the free bodies have come; velocities zero; ids, bodies and flags set.
  const coupling::WetSurface& at(double t);
  /// A window of dt after t.
  std::vector<Vec3> positions(double t, double dt = 0) const;
  /// Nothing ever moves.
  bool fixed() const { return fixed_; }

  // --- bodies that the flow moves
  const std::vector<FreeBody>& free() const { return free_; }
  /// Before the first window: no gas around them has more than this rho c [kg/(m^2 s)].
  void begin(double rho_c);
  /// The window of dt is over: its loads move the free bodies. Faces in closed gaps, whose loads are dry, take the
  /// pressure of the faces beside them.
  /// links: forces of conservative loads in place of pressures; nullptr: none.
  void advance(double dt, const coupling::Loads& loads, double p_ref, const FaceForces* links = nullptr);
  /// s: with longer steps a body lighter than the gas that it moves would swing.
  double largest_step() const { return largest_step_; }
  void save(const Saved& to) const;
  void restore(const Restored& from);

 private:
  void add_free(const BodyCase& body, const FreeMotion& motion, int32_t first_face);
  /// largest_step() under gas of rho c A [kg/s] on each face of the surface.
  void limit_step(const std::function<double(size_t)>& rho_c_area);
  /// Pressure above p_ref on the body's faces.
  std::vector<double> pressures_of(const FreeBody& f, const RigidBody::Place& at, const coupling::Loads& loads,
                                   double p_ref) const;

  coupling::WetSurface surface_;
  ShapeSetting setting_;
  std::vector<Vec3> X_;           ///< [n_nodes] at t = 0
  std::vector<int32_t> body_of_;  ///< [n_nodes]
  std::vector<Motion> motion_;
  std::vector<FreeBody> free_;
  std::vector<int32_t> free_of_;                ///< [body] into free_, -1: prescribed
  std::vector<std::array<int32_t, 4>> beside_;  ///< [face] the faces across its edges, -1: none; of free bodies
  bool fixed_ = true;
  double largest_step_ = 1e300;
};

}  // namespace bw::cfd
