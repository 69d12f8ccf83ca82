// SPDX-License-Identifier: Apache-2.0
// A mesh file as plain lists, whatever its format, and the mesh that they make.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/math/tensor.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

struct FileElement {
  int64_t tag = 0;
  int type = 0;  ///< Gmsh's number: 1 line, 2 triangle, 3 quadrangle, 4 tetrahedron, 5 hexahedron, 15 point
  std::vector<int> physical;     ///< groups that it is in
  std::array<int64_t, 8> nodes;  ///< tags; as many as the type has
  size_t offset = 0;             ///< where it stands in the file
};

struct MeshFile {
  std::vector<int64_t> node_tag;
  std::vector<Vec3> x;
  std::vector<FileElement> elements;
  std::map<std::pair<int, int>, std::string> names;  ///< (dimension, number) of named physical groups
  std::string path, text;
  struct Piece {
    size_t begin;  ///< in the text
    std::string path;
    int64_t first_line;
  };
  std::vector<Piece> pieces;  ///< files that the text is made of, ascending; empty: all of it is `path`
  bool is_binary = false;
  bool repeats_elements = false;  ///< one is written anew for each of its groups

  /// "path:line" or "path: byte n" of an offset.
  std::string at(size_t offset) const;
  std::string group(int dimension, int number) const;
};

namespace element_type {
inline constexpr int triangle = 2, quadrangle = 3, tetrahedron = 4, hexahedron = 5, point = 15;
}
int element_dimension(int type);
int element_node_count(int type);

/// The whole text of a file. InputError, naming `place`, if it can't be opened.
std::string read_mesh_text(const std::string& path, const std::string& place);

/// Hexahedra as they are, tetrahedra split into four hexahedra each. Groups become sets of their name (or number):
/// volumes -> elements, surfaces -> faces and nodes, curves and points -> nodes. Global ids count in file order; nodes
/// of no volume element are left out. `only`: names of element groups, the rest is left out; empty: all. InputError at
/// the place in the file, `place` (of the case) if it has no volume elements.
Mesh mesh_of(MeshFile file, const std::vector<std::string>& only, const std::string& place);

}  // namespace bw::csd
