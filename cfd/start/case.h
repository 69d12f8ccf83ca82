// SPDX-License-Identifier: Apache-2.0
// [fluid.start_from]: a run along a radius ended here, and this run begins with what it left.
#pragma once
#include <string>

#include "common/math/tensor.h"
#include "common/math/units.h"

namespace bw::cfd {

struct StartCase {
  std::string file, axis = "z", place;
  Vec3 centre;
  bool keep_time = false;
  template <class K>
  void describe(K& k) {
    k.required("file", file, "fluid_profile.h5 of a run along a radius, whose burn is over");
    k.optional("centre", centre, dim::length, "where its centre comes to lie; symmetry planes may pass through it");
    k.choice("axis", axis, {"x", "y", "z"}, "of a cylindrical profile");
    k.optional("keep_time", keep_time, "begin at the profile's time instead of 0");
    if (!k.is_manual()) file = k.resolve_path(file);
    place = k.where("file");
  }
};

}  // namespace bw::cfd
