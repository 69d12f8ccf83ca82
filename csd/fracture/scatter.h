// SPDX-License-Identifier: Apache-2.0
// Weibull's statistics: the strength of an element, over the mean one, is drawn from the seed and its global id.
#pragma once
#include <cmath>

#include "common/math/random.h"
#include "common/math/units.h"

namespace bw::csd {

/// [solid.fracture.scatter]
struct Scatter {
  double modulus = 0, reference_volume = 0;
  int seed = 1;
  template <class K>
  void describe(K& k) {
    k.required("modulus", modulus, dim::none,
               "Weibull's modulus m of the limits; their standard deviation is about 1.2/m of the mean");
    k.optional(
        "reference_volume", reference_volume, dim::volume,
        "volume whose mean strength the criterion's limit is: an element of volume V is (reference_volume/V)^(1/m) "
        "times as strong; 0: no effect of size");
    k.optional("seed", seed, "of the random strengths");
    k.expect(modulus >= 1, "modulus", "a number from 1");
    k.expect(reference_volume >= 0, "reference_volume", "a volume >= 0");
  }
  /// The failure value is divided by it; mean 1 at the reference volume.
  double strength(int64_t gid, double volume) const {
    const double u = uniform01(uint64_t(seed), uint64_t(gid));
    const double size = reference_volume > 0 ? std::pow(reference_volume / volume, 1 / modulus) : 1;
    return size * std::pow(-std::log1p(-u), 1 / modulus) / std::tgamma(1 + 1 / modulus);
  }
};

}  // namespace bw::csd
