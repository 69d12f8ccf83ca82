// SPDX-License-Identifier: Apache-2.0
// A mesh of trilinear hexahedra. Nodes of a hex: bottom 0-1-2-3 counter-clockwise seen from the top, top 4-5-6-7 above them (VTK, Gmsh).
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/data/field.h"
#include "common/math/tensor.h"

namespace bw::csd {

/// Side 0..5 of a hex: -xi, +xi, -eta, +eta, -zeta, +zeta. Its nodes in face_nodes are counter-clockwise seen from outside.
inline constexpr int face_nodes[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};

struct Face {
  ElemId elem;
  int side = 0;
  friend bool operator==(const Face&, const Face&) = default;
};

/// Sides of elements have 32-bit numbers.
inline constexpr double most_elements = 2147483647 / 6;
inline constexpr const char* few_enough = "fewer than 358 million elements in all";

struct Mesh {
  Field<Vec3, NodeId> X;                           ///< reference position [m]
  Field<std::array<NodeId, 8>, ElemId> hex;        ///< connectivity, changed by cracks only
  Field<int32_t, ElemId> body;                     ///< index of the [[solid.body]] that the element belongs to
  Field<int64_t, NodeId> node_gid;                 ///< stable global ids: input order, then order of birth
  Field<int64_t, ElemId> elem_gid;
  Field<NodeId, NodeId> parent;                    ///< node it was split from, -1: original
  std::map<std::string, std::vector<NodeId>> node_sets;
  std::map<std::string, std::vector<ElemId>> elem_sets;
  std::map<std::string, std::vector<Face>> face_sets;  ///< faces of the original boundary, by name

  int node_count() const { return int(X.size()); }
  int elem_count() const { return int(hex.size()); }
  std::array<NodeId, 4> nodes_of(Face f) const {
    const auto& h = hex[f.elem];
    const auto& k = face_nodes[f.side];
    return {h[k[0]], h[k[1]], h[k[2]], h[k[3]]};
  }
};

}  // namespace bw::csd
