// SPDX-License-Identifier: Apache-2.0
// The two lips of a crack: how far apart are they?
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "coupling/surface.h"

namespace bw::cfd {

class Lips {
 public:
  /// Pairs the lips of a surface of new topology: the faces whose nodes were the same before all splits. Remembers the
  /// splits.
  void pair(const coupling::WetSurface& surface);
  static constexpr double apart = 1e30;
  /// Distance of the twin along the face's normal [m], negative where they overlap; `apart` without a twin, or where
  /// the lips slid past each other.
  double aperture(const coupling::WetSurface& surface, int32_t face) const;

 private:
  std::unordered_map<int64_t, int64_t> parent_;  ///< node_id -> node_id, of all splits so far
  std::vector<int32_t> twin_;                    ///< [n_faces] -1: none
};

}  // namespace bw::cfd
