// SPDX-License-Identifier: Apache-2.0
// A rigid body that the flow moves: mass properties of a closed surface, and the motion from window to window.
// A window of dt takes the walls along the displacement that the last window's loads let expect; the loads of the
// window (at its middle) then give the velocities at its end and the true displacement, and what the walls lack of that
// is their next displacement's first part: second order in time, nothing drifts apart.
//   v += dt F/m,  l += dt M,  x += dt v + dt^2/2 F/m,  R = exp(dt w_mid) R,  w = (R I R^T)^-1 l
#pragma once
#include <array>
#include <vector>

#include "common/math/attitude.h"

namespace bw::cfd {

struct MassProperties {
  double mass = 0;  ///< kg
  Vec3 centre;      ///< of mass, in the body's axes (those of the case at the start) [m]
  Mat3 inertia{};   ///< about the centre [kg m^2]
};
/// Of density 1 in a closed surface of quads (fans of triangles, cfd/embed/scan.h); mass <= 0: it encloses nothing.
MassProperties solid_of(const std::vector<Vec3>& X, const std::vector<std::array<int32_t, 4>>& quads);

class RigidBody {
 public:
  /// free: may it move along x, y, z and turn about x, y, z? velocity [m/s] and spin [rad/s] at the start: 0 where it
  /// may not.
  RigidBody(const MassProperties& mass, const std::array<bool, 6>& free, const Vec3& velocity, const Vec3& spin);

  struct Place {
    Vec3 shift;  ///< of the centre since the start
    Attitude turn;
  };
  /// Where the walls are now, and after a window of dt.
  const Place& place() const { return s_.place; }
  Place after(double dt) const;
  Vec3 turn_angle(double dt) const;  ///< of the walls in that window [rad]
  /// Half way to after(dt): where its loads act.
  Place halfway(double dt) const;
  /// The window is over; force [N], moment about the centre half way [N m], and work of the fluid on the walls [J].
  void advance(double dt, const Vec3& force, const Vec3& moment, double work);
  Vec3 position(const Vec3& X, const Place& at) const;

  const MassProperties& mass() const { return mass_; }
  Vec3 centre() const { return mass_.centre + s_.place.shift + s_.gap; }  ///< the body's own
  const Vec3& velocity() const { return s_.velocity; }
  const Vec3& angular_momentum() const { return s_.spin_momentum; }
  Vec3 spin() const { return inverse_inertia(s_.place.turn) * s_.spin_momentum; }
  double kinetic_energy() const;
  /// (R I R^T)^-1 among the turns that are free, 0 elsewhere [1/(kg m^2)].
  Mat3 inverse_inertia(const Attitude& turn) const;
  bool free(int dof) const { return free_[size_t(dof)]; }

  /// Plain data: written to checkpoints as it is.
  struct State {
    Place place;                   ///< of the walls
    Vec3 gap, turn_gap;            ///< what they lack [m, rad]
    Vec3 velocity, spin_momentum;  ///< m/s, kg m^2/s
    Vec3 force, moment;            ///< of the last window, held directions included
    Vec3 impulse, twist;           ///< their sums over time [N s, N m s]
    double work = 0;               ///< J
  };
  const State& state() const { return s_; }
  void restore(const State& s) { s_ = s; }

 private:
  Vec3 freed(const Vec3& a, int first) const;

  MassProperties mass_;
  std::array<bool, 6> free_;
  State s_;
};

}  // namespace bw::cfd
