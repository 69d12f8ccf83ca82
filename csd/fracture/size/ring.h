// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace bw::csd {

/// Means over a ring of the body about its axis when it breaks up.
struct RingState {
  double radius = 0;   ///< m
  double speed = 0;    ///< m/s, away from the axis
  double stress = 0;   ///< Pa, flow stress
  double density = 0;  ///< kg/m^3
};

}  // namespace bw::csd
