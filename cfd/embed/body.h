// SPDX-License-Identifier: Apache-2.0
// Stand-alone bodies, [[fluid.body]]: a shape, where it is turned, and how it moves. Together they are one surface.
#pragma once
#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "cfd/embed/shapes.h"

namespace bw::cfd {

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
using Motion = std::variant<FixedMotion, VelocityMotion, TableMotion, PulseMotion, OscillationMotion, RotationMotion>;

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

/// All bodies of a case as one surface.
class Bodies {
 public:
  Bodies(const std::vector<BodyCase>& bodies, const ShapeSetting& setting);
  bool empty() const { return surface_.quads.empty(); }
  /// Positions at t, velocities zero; ids, bodies and flags set.
  const coupling::WetSurface& at(double t);
  std::vector<Vec3> positions(double t) const;
  /// Nothing ever moves.
  bool fixed() const { return fixed_; }

 private:
  coupling::WetSurface surface_;
  std::vector<Vec3> X_;           ///< [n_nodes] at t = 0
  std::vector<int32_t> body_of_;  ///< [n_nodes]
  std::vector<Motion> motion_;
  bool fixed_ = true;
};

}  // namespace bw::cfd
