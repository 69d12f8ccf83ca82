// SPDX-License-Identifier: Apache-2.0
// What the two programs say to each other, as plain data (SI, absolute pressure). coupling/PROTOCOL.md has the bytes.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/math/tensor.h"

namespace bw::coupling {

/// Flags of a face.
enum FaceFlag : int32_t {
  face_lip = 1,   ///< made by a crack; its two lips lay on each other when it was born
  face_thin = 2,  ///< part of an open shell: wet on both sides, encloses nothing
};

/// The wetted surface of the solid: quads whose normal points into the fluid (a triangle has its last node twice).
struct WetSurface {
  int64_t topo_version = 0;  ///< changes if and only if anything below the velocities changes
  std::vector<Vec3> x;       ///< [n_nodes] m
  std::vector<Vec3> v;       ///< [n_nodes] m/s
  std::vector<std::array<int32_t, 4>> quads;  ///< [n_faces] indices into x
  std::vector<int64_t> node_id, face_id;      ///< stable, never reused
  std::vector<int64_t> node_parent;           ///< [n_nodes] node_id that this node was split from, -1: original
  std::vector<int32_t> body;                  ///< [n_faces] input body
  std::vector<int32_t> flags;                 ///< [n_faces] FaceFlag bits
};

/// Area vector of a quad, A = 1/2 d13 x d24 [m^2]; exact for a triangle too.
inline Vec3 area_vector(const std::vector<Vec3>& x, const std::array<int32_t, 4>& q) {
  return 0.5 * cross(x[q[2]] - x[q[0]], x[q[3]] - x[q[1]]);
}

}  // namespace bw::coupling
