// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// A Gmsh file, format 2.2 or 4.1, ASCII or binary: first-order hexahedra, and tetrahedra that are split into four
/// hexahedra each. Physical groups become sets of their name (or number): volumes -> elements, surfaces -> faces and
/// nodes, curves and points -> nodes. elem_gid and node_gid count in file order. Nodes of no element are left out.
struct Gmsh {
  std::string file;
  std::vector<std::string> elements;
  static constexpr auto name = "gmsh";
  template <class K>
  void describe(K& k) {
    k.required("file", file,
               "path of the .msh file (format 2.2 or 4.1, hexahedra or tetrahedra), relative to the case file");
    k.optional("elements", elements, "names of physical volumes: the body is made of them alone; empty: of all");
    if (!k.is_manual()) {
      place = k.where("file");
      file = k.resolve_path(file);
    }
  }
  /// InputError with file and line (ASCII) or byte (binary): missing or broken file, no volume elements, unsupported
  /// elements.
  Mesh make() const;
  std::string place;  // of the key
};

}  // namespace bw::csd
