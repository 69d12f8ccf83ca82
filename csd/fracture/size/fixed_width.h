// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "common/math/units.h"
#include "csd/fracture/size/ring.h"

namespace bw::csd {

/// Fragments as wide as the user says: a scored or grooved case.
struct FixedWidth {
  double given = 0;
  static constexpr auto name = "fixed";
  template <class K>
  void describe(K& k) {
    k.required("width", given, dim::length, "of fragments, around the axis, when the ring breaks up");
    k.expect(given > 0, "width", "a positive length");
  }
  double width(const RingState&) const { return given; }
};

}  // namespace bw::csd
