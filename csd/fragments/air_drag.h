// SPDX-License-Identifier: Apache-2.0
// Drag of still air on fragments too small for the fluid's cells: 1/2 rho Cd A v^2 against the velocity, by the mean
// presented area of a tumbling body. At constant Cd  v = v_0 exp(-x/L),  L = 2 m/(rho Cd A).
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw::csd {

/// [solid.rigid.drag]
struct DragInput {
  double density = 0, sound_speed = 0, size = 0, shape_factor = 0;
  std::vector<double> mach, coefficient;
  std::string place;  // of size
  template <class K>
  void describe(K& k) {
    k.required("density", density, dim::density, "of the air, which is at rest");
    k.required("sound_speed", sound_speed, dim::velocity, "of the air");
    k.required("mach", mach, dim::none, "Mach numbers, rising, at which `coefficient` is given");
    k.required(
        "coefficient", coefficient, dim::none,
        "of drag on the mean presented area; linear between them, constant beyond. About 1.2 for chunky tumbling "
        "fragments above the speed of sound");
    k.optional(
        "size", size, dim::length,
        "only rigid bodies with no node further than half of it from their centre; in a pair the size of a cell: "
        "larger ones feel the fluid's pressures. 0: all, not in a pair");
    k.optional("shape_factor", shape_factor, dim::none,
               "mean presented area over mass^(2/3) [m^2/kg^(2/3)], as in the table of fragments; 0: a quarter of each "
               "body's own surface");
    k.expect(density > 0, "density", "a positive density");
    k.expect(sound_speed > 0, "sound_speed", "a positive velocity");
    k.expect(size >= 0, "size", "a length >= 0");
    k.expect(shape_factor >= 0, "shape_factor", "a number >= 0");
    if (!k.is_manual()) place = k.where("size");
    bool rises = !mach.empty(), positive = true;
    for (size_t i = 1; i < mach.size(); ++i) rises = rises && mach[i] > mach[i - 1];
    for (const double c : coefficient) positive = positive && c >= 0;
    k.expect(rises && mach.front() >= 0, "mach", "numbers >= 0 that rise");
    k.expect(positive && coefficient.size() == mach.size(), "coefficient", "as many numbers >= 0 as `mach` has");
  }

  double coefficient_at(double speed) const {
    const double M = speed / sound_speed;
    const size_t i = size_t(std::upper_bound(mach.begin(), mach.end(), M) - mach.begin());
    if (i == 0) return coefficient.front();
    if (i == mach.size()) return coefficient.back();
    return coefficient[i - 1] + (M - mach[i - 1]) / (mach[i] - mach[i - 1]) * (coefficient[i] - coefficient[i - 1]);
  }
  /// Force [N] on a body of `mass` [kg] and `area` [m^2] at the end of a step, by the velocity v that it brings about
  /// itself: v + h k v |v| = w, k = rho Cd A/(2 m); w [m/s]: what the other forces make of it; h: half the step.
  Vec3 force(double area, double mass, const Vec3& w, double h) const {
    const double given = norm(w);
    if (given == 0) return {};
    double v = given, k = 0;
    for (int i = 0; i < 4; ++i) {  // Cd by the speed: a contraction with the factor h k v << 1
      k = 0.5 * density * area / mass * coefficient_at(v);
      v = 2 * given / (1 + std::sqrt(1 + 4 * h * k * given));
    }
    return (-mass * k * v * v / given) * w;
  }
};

}  // namespace bw::csd
