// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

namespace bw::csd {

/// What elements store and have spent [J], and the largest values of their points.
struct StoredEnergy {
  double elastic = 0, plastic = 0, heat = 0, collapse = 0;
  double eqps_max = 0, temperature_max = 0;  // K

  void add(const StoredEnergy& e) {
    elastic += e.elastic, plastic += e.plastic, heat += e.heat, collapse += e.collapse;
    eqps_max = std::max(eqps_max, e.eqps_max), temperature_max = std::max(temperature_max, e.temperature_max);
  }
};

}  // namespace bw::csd
