// SPDX-License-Identifier: Apache-2.0
// What a run along a radius leaves for others to begin with: fluid_profile.h5.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "cfd/build.h"

namespace bw::cfd {

struct Profile {
  std::string file;
  Geometry geometry = Geometry::spherical;
  double t = 0;                        ///< s
  std::vector<std::string> materials;
  std::vector<double> probes;          ///< their e(rho, p) at a few states, to tell other materials of the same name
  std::vector<double> r;               ///< [shells + 1] m
  std::vector<std::array<double, Cons::most>> U;  ///< [shells] momentum along the radius; E counts from e = 0 of the
                                                   ///< equations of state as given (no e_shift); rows as in `materials`
  /// Shells up to here differ from the last one: where the undisturbed gas begins [m].
  double reach() const;
};

/// At the end of a run along a radius. Collective.
void write_profile(const std::string& path, const Model& m);
/// place: of the key that names it. InputError if it is none, or its burn was not over.
Profile read_profile(const std::string& path, const std::string& place);
/// e(rho, p) of the materials at a few states, with the zero of e that the equations of state have by themselves.
std::vector<double> probe_materials(const Medium& medium);

}  // namespace bw::cfd
