// SPDX-License-Identifier: Apache-2.0
// How long a window may be when light faces move against a dense fluid.
//
// A face of areal mass m under a fluid of impedance Z = rho c feels -Z v. With loads frozen over the window and the
// wall's velocity predicted, r = Z dt / m must stay below 1/2 (fluid_first; roots of the amplification matrix), on a
// chip that is wet on two sides below 1/4.
#pragma once
#include <algorithm>
#include <limits>
#include <span>
#include <unordered_map>
#include <vector>

#include "coupling/surface.h"

namespace bw::coupling {

class AddedMass {
 public:
  /// share: largest r that a window may have; 0: no limit.
  explicit AddedMass(double share) : share_(share) {}

  /// The coming window's surface and the areal masses of its faces [kg/m^2] (empty: unknown). Returns the longest
  /// window [s]: by the impedances of the last answer; faces that were not there then do not count. Before the first
  /// answer: first.
  double longest_window(const WetSurface& surface, std::span<const double> areal_mass, double first) {
    areal_mass_.assign(areal_mass.begin(), areal_mass.end());
    double longest = std::numeric_limits<double>::infinity();
    if (!areal_mass_.empty() && !answered_ && share_ > 0) longest = first;
    if (!areal_mass_.empty() && !impedance_.empty() && share_ > 0) {
      // faces keep their places as long as none is gone: new ones follow
      const size_t old = face_id_.size();
      const bool grown =
          old <= surface.face_id.size() && std::equal(face_id_.begin(), face_id_.end(), surface.face_id.begin());
      std::unordered_map<int64_t, double> by_id;
      for (size_t f = 0; !grown && f < old; ++f) by_id[face_id_[f]] = impedance_[f];
      for (size_t f = 0; f < areal_mass_.size(); ++f) {
        double Z = 0;
        if (grown)
          Z = f < old ? impedance_[f] : 0;
        else if (const auto known = by_id.find(surface.face_id[f]); known != by_id.end())
          Z = known->second;
        if (Z > 0) longest = std::min(longest, share_ * areal_mass_[f] / Z);
      }
    }
    if (surface.topo_version != topo_version_ || face_id_.size() != surface.face_id.size()) {
      face_id_ = surface.face_id;
      topo_version_ = surface.topo_version;
    }
    impedance_.clear();
    return longest;
  }

  /// The fluid's answer for that surface [kg/(m^2 s)] (empty: unknown), and the window's length. Returns the largest r.
  double answer(std::span<const double> impedance, double dt) {
    answered_ = true;
    impedance_.assign(impedance.begin(), impedance.end());
    double largest = 0;
    if (impedance_.size() == areal_mass_.size())
      for (size_t f = 0; f < areal_mass_.size(); ++f) largest = std::max(largest, impedance_[f] * dt / areal_mass_[f]);
    return largest;
  }

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.value("answered", answered_), a.value("topo_version", topo_version_), a.list("face_id", face_id_);
    a.list("areal_mass", areal_mass_), a.list("impedance", impedance_);
  }

 private:
  double share_;
  bool answered_ = false;
  int64_t topo_version_ = -1;
  std::vector<int64_t> face_id_;
  std::vector<double> areal_mass_, impedance_;
};

}  // namespace bw::coupling
