// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/tensor.h"

namespace bw::csd {

/// What a failure criterion is told about an element after a step.
struct Sample {
  double eqps = 0;          ///< mean over the points
  double sigma_m = 0;       ///< Pa, mean stress, tension positive
  double mises_most = 0;    ///< Pa, no less than Mises' stress; infinite if nothing is known
  double dt = 0;            ///< s, the step
  bool has_stress = false;  ///< the rest is known
  Sym3 sigma = {};          ///< Pa, mean Cauchy stress
  double temperature = 0;   ///< K, mean over the points
};

}  // namespace bw::csd
