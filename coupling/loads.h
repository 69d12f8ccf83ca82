// SPDX-License-Identifier: Apache-2.0
// What the fluid answers to a surface, as plain data (SI, absolute pressure), and how it loads the solid.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coupling/surface.h"

namespace bw::coupling {

/// One exchange: the solid stands at t0 and allows the fluid to go to t1_max at most.
struct Window {
  int64_t index = 0;        ///< 0, 1, ... ; set by SolidSide
  double t0 = 0;            ///< s
  double t1_max = 0;        ///< s, > t0
  double dt_stable = 0;     ///< s, the solid's stable step at t0 (for the fluid's log only)
  bool checkpoint = false;  ///< the fluid is to keep its state at t0
  bool last = false;        ///< the solid ends after this window, wherever the fluid's t1 is
  bool fixed = false;       ///< the fluid is to go to t1_max, in as many steps as it needs
  bool mean_pressure =
      true;  ///< the solid wants the window's mean pressure (fluid_first), else the pressure at t1 (box1)
};

/// The fluid's books of one window. Impulse, moment and work are those of the wetted faces only.
struct FluidTotals {
  Vec3 impulse;                                 ///< N s, sum of -P A dt: what the fluid gave to the solid
  Vec3 moment;                                  ///< N m s about the origin, lever = face centre at the window's start
  double work = 0;                              ///< J, sum of -P A . v_wall dt: done by the fluid on its walls
  double swept = 0;                             ///< m^3, sum of A . v_wall dt: taken from the fluid by its walls
  double mass = 0, energy = 0;                  ///< kg, J of the whole fluid at t1
  Vec3 momentum;                                ///< kg m/s of the whole fluid at t1
  double mass_covered = 0, mass_uncovered = 0;  ///< kg, since the start, lost and made by cells that a wall swept
  double energy_covered = 0, energy_uncovered = 0;  ///< J
  int64_t dry_faces = 0;  ///< faces that the fluid could not see (they got the reference pressure)
  double dry_area = 0;    ///< m^2
};

/// The fluid's answer. Faces in the order of the surface with the same topo_version.
struct Loads {
  double t1 = 0;                  ///< s, end of the window: t0 < t1 <= t1_max
  bool stop = false;              ///< the fluid asks to end after this window
  bool checkpoint = false;        ///< the fluid asks for a checkpoint at the end of this window
  double dt_next = 0;             ///< s, the step that the fluid would take next; 0: unknown
  std::vector<double> p;          ///< [n_faces] Pa, absolute
  std::vector<Vec3> traction;     ///< [n_faces] Pa, beyond -p n; empty: none
  std::vector<double> impedance;  ///< [n_faces] kg/(m^2 s), rho c of the fluid at the face; empty: unknown
  FluidTotals totals;
};

/// Of each face [m^2].
std::vector<Vec3> area_vectors(const WetSurface& surface);

/// The force of each face on the solid, -(P - p_ref) A [+ traction |A|], by its area vector [N].
std::vector<Vec3> face_forces(std::span<const Vec3> area, const Loads& loads, double p_ref);

/// A face's force goes to its nodes in equal parts, quarters of a quad and thirds of a triangle: [n_nodes] N.
std::vector<Vec3> nodal_loads(const WetSurface& surface, std::span<const Vec3> face_force);
inline std::vector<Vec3> nodal_loads(const WetSurface& surface, const Loads& loads, double p_ref) {
  return nodal_loads(surface, face_forces(area_vectors(surface), loads, p_ref));
}

/// The fluid's impulse, moment and work on the wetted faces for these loads; v_wall [n_nodes] is the velocity that the
/// walls really had (the gap's repayment included). Sums in face order. The other members of FluidTotals are the
/// caller's.
FluidTotals wall_totals(const WetSurface& surface, const Loads& loads, std::span<const Vec3> v_wall,
                        const Window& window);

inline bool is_triangle(const std::array<int32_t, 4>& q) { return q[3] == q[2]; }
/// Mean of the face's nodes, a triangle's last node once.
inline Vec3 face_mean(std::span<const Vec3> a, const std::array<int32_t, 4>& q) {
  const Vec3 three = a[size_t(q[0])] + a[size_t(q[1])] + a[size_t(q[2])];
  return is_triangle(q) ? three / 3.0 : (three + a[size_t(q[3])]) / 4.0;
}

}  // namespace bw::coupling
