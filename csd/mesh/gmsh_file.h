// SPDX-License-Identifier: Apache-2.0
// The bytes of a Gmsh file as plain lists.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/math/tensor.h"

namespace bw::csd {

struct GmshElement {
  int64_t tag = 0;
  int type = 0;  ///< Gmsh's number: 1 line, 2 triangle, 3 quadrangle, 4 tetrahedron, 5 hexahedron, 15 point
  std::vector<int> physical;     ///< groups that it is in
  std::array<int64_t, 8> nodes;  ///< tags; as many as the type has
  size_t offset = 0;             ///< where it stands in the file
};

struct GmshFile {
  std::vector<int64_t> node_tag;
  std::vector<Vec3> x;
  std::vector<GmshElement> elements;
  std::map<std::pair<int, int>, std::string> names;  ///< (dimension, number) of named physical groups
  std::string path, text;
  bool is_binary = false;

  /// "path:line" or "path: byte n" of an offset.
  std::string at(size_t offset) const;
  std::string group(int dimension, int number) const;
};

int gmsh_dimension(int type);
int gmsh_node_count(int type);

/// Reads format 2.2 or 4.1. InputError at the place where the file is not what it should be; `place` is named if it
/// can't be opened.
GmshFile read_gmsh(const std::string& path, const std::string& place);

}  // namespace bw::csd
