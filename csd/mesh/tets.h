// SPDX-License-Identifier: Apache-2.0
// Each tetrahedron into four hexahedra: nodes at the mid-edges, face centres and the centre, as the paper's meshes are
// made.
#pragma once
#include <array>
#include <unordered_map>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Splits tets over points; the points keep their numbers 0..n-1 in front of the new nodes.
class TetSplit {
 public:
  TetSplit(std::vector<Vec3> points, const std::vector<std::array<int32_t, 4>>& tets);
  std::vector<Vec3> x;
  std::vector<std::array<int32_t, 8>> hexes;   ///< four for each tet, in the order of the tets
  std::vector<std::array<int32_t, 4>> origin;  ///< points whose mean a node is, -1: fewer than four
  /// The three quads that a triangle of the tets became; nodes -1 if no tet has that triangle.
  std::array<std::array<int32_t, 4>, 3> quads_of(std::array<int32_t, 3> triangle) const;
  /// Mid-node of an edge of the tets, -1: no such edge.
  int32_t middle_of(int32_t a, int32_t b) const { return find({a, b, -1}); }

 private:
  struct Key {
    uint64_t ab;
    uint32_t c;
    friend bool operator==(const Key&, const Key&) = default;
  };
  struct Hash {
    size_t operator()(const Key& k) const { return k.ab * 0x9e3779b97f4a7c15ull ^ k.c * 0xc2b2ae3d27d4eb4full; }
  };
  static Key key(std::array<int32_t, 3> corners);
  int32_t mean_node(std::array<int32_t, 4> corners, int n);
  int32_t find(std::array<int32_t, 3> corners) const;
  int32_t middle(std::array<int32_t, 3> corners, int n);
  std::unordered_map<Key, int32_t, Hash> middle_;  // of edges (c = -1) and faces
};

}  // namespace bw::csd
