// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "csd/mesh/from_file.h"

namespace bw::csd {

/// A Gmsh file, format 2.2 or 4.1, ASCII or binary: first-order hexahedra, and tetrahedra that are split into four
/// hexahedra each. Physical groups become sets of their name (or number): volumes -> elements, surfaces -> faces and
/// nodes, curves and points -> nodes. elem_gid and node_gid count in file order. Nodes of no element are left out.
struct Gmsh : FromFile {
  static constexpr auto name = "gmsh";
  template <class K>
  void describe(K& k) {
    FromFile::describe(k,
                       "path of the .msh file (format 2.2 or 4.1, hexahedra or tetrahedra), relative to the case file",
                       "names of physical volumes: the body is made of them alone; empty: of all");
  }
  /// InputError with file and line (ASCII) or byte (binary): missing or broken file, no volume elements, unsupported
  /// elements.
  Mesh make() const;
};

}  // namespace bw::csd
