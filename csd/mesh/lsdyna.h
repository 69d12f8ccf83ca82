// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Nodes, solid elements and sets of an LS-DYNA keyword file: *NODE, *ELEMENT_SOLID (hexahedra; tetrahedra, written
/// with repeated nodes, become four hexahedra), *PART (element sets by title, or number), *SET_NODE, *SET_SOLID,
/// *SET_SEGMENT (by title, or number). Fields of standard width or between commas. Other keywords are passed over.
struct LsDyna {
  std::string file;
  std::vector<std::string> elements;
  static constexpr auto name = "lsdyna";
  template <class K>
  void describe(K& k) {
    k.required("file", file, "path of the .k file, relative to the case file");
    k.optional("elements", elements, "titles of parts or element sets: the body is made of them alone; empty: of all");
    if (!k.is_manual()) {
      place = k.where("file");
      file = k.resolve_path(file);
    }
  }
  /// InputError with file and line.
  Mesh make() const;
  std::string place;  // of the key
};

}  // namespace bw::csd
