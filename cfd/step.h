// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "cfd/books.h"

namespace bw::cfd {

/// Where the walls of a window are and go: the coupled solid's, or bodies with prescribed motion.
class WallMotion {
 public:
  virtual ~WallMotion() = default;
  virtual const coupling::WetSurface& surface() const = 0;
  virtual std::vector<Vec3> x() const = 0;                  ///< [n_nodes] at the window's start
  virtual std::vector<Vec3> velocity(double dt) const = 0;  ///< [n_nodes] constant over a window of dt
  virtual std::vector<Vec3> x_end(double dt) const = 0;     ///< [n_nodes] after it
};

/// One step of at most dt_max, as far as stability and the walls allow; halved and repeated when it fails. Returns dt.
/// motion: nullptr without walls. loads: filled with the window's mean pressures (mean) or those at its end.
/// PhysicsError names the cell if even small steps fail.
double step(Model& m, Sweep& sweep, Books& books, double dt_max, const WallMotion* motion, bool mean, coupling::Loads* loads);

}  // namespace bw::cfd
