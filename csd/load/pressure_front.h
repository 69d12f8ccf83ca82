// SPDX-License-Identifier: Apache-2.0
// The prescribed detonation load, eq (18): a front runs along an axis; behind it p = peak exp(-d / length), d =
// distance behind the front; ahead of it nothing.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "csd/load/face_load.h"
#include "csd/load/loaded_faces.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

struct PressureFront {
  static constexpr auto name = "pressure_front";
  double peak = 0, decay = 0, speed = 0, start_time = 0;
  Vec3 axis{0, 0, 1}, start{};
  std::vector<std::string> faces;
  std::vector<double> behind, factors;
  std::string place;

  template <class K>
  void describe(K& k) {
    k.required("peak", peak, dim::pressure, "pressure at the front, eq (18): 1e11 dyn/cm^2 in the paper");
    k.optional("decay", decay, dim::per_length,
               "the pressure behind the front falls by exp(-decay d), eq (18): 0.1 /cm in the paper");
    k.optional("behind", behind, dim::length,
               "in place of `decay`, any other: distances behind the front, rising from 0");
    k.optional("factors", factors, dim::none, "on `peak` at these distances; linear between, the last one beyond");
    k.required("speed", speed, dim::velocity, "of the front: 7.2e5 cm/s in the paper");
    k.optional("axis", axis, dim::none, "direction in which the front runs (of any length)");
    k.optional("start", start, dim::length, "a point of the front at start_time");
    k.optional("start_time", start_time, dim::time, "when the front stands at `start`");
    k.required("faces", faces,
               "names of the face sets that are loaded: the original inner surface; faces made by cracks never are");
    k.expect(peak >= 0, "peak", "a pressure >= 0");
    k.expect(decay >= 0, "decay", "a number per length >= 0");
    k.expect(k.has("decay") != !behind.empty(), "decay", "either `decay` or the table `behind`, `factors`");
    k.expect(behind.size() == factors.size(), "factors", "as many values as `behind`");
    k.expect(behind.empty() || behind[0] == 0, "behind", "0 as the first distance");
    k.expect(std::is_sorted(behind.begin(), behind.end(), std::less_equal<>()), "behind", "rising distances");
    k.expect(speed > 0, "speed", "a positive velocity");
    k.expect(norm(axis) > 0, "axis", "a direction other than (0, 0, 0)");
    if (!k.is_manual()) place = k.where("faces");
  }

  void select(const Mesh& mesh) {
    set_ = {mesh, face_sets(mesh, faces, place)}, profile_ = {behind, factors}, along_ = unit(axis);
  }
  /// Pa, at a point; after select.
  double pressure(const Vec3& x, double t) const {
    const double d = speed * (t - start_time) - dot(x - start, along_);
    if (t < start_time || d < 0) return 0;
    return peak * (profile_.times.empty() ? std::exp(-decay * d) : profile_.at(d));  // eq (18)
  }
  void add(const Mesh& mesh, const Field<Vec3, NodeId>& x, const Field<double, NodeId>&, double t,
           Field<Vec3, NodeId>& f) const {
    set_.add(*this, mesh, x, t, f);
  }
  LoadedFaces& set() { return set_; }
  double at(double t) const { return t; }
  template <class Force>
  void on_face(size_t, const std::array<Vec3, 4>& x, double t, const Force& force) const {
    if (const double p = pressure(centre_of(x), t); p > 0) add_pressure(x, p, force);
  }

 private:
  LoadedFaces set_;
  Table profile_;  // factor by distance
  Vec3 along_;     // unit
};

}  // namespace bw::csd
