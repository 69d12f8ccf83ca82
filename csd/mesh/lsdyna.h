// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "csd/mesh/from_file.h"

namespace bw::csd {

/// Nodes, solid elements and sets of an LS-DYNA keyword file: *NODE, *ELEMENT_SOLID (hexahedra; tetrahedra, written
/// with repeated nodes, become four hexahedra), *PART (element sets by title, or number), *SET_NODE, *SET_SOLID,
/// *SET_SEGMENT (by title, or number), *INCLUDE. Fields of standard width or between commas. Other keywords are passed
/// over.
struct LsDyna : FromFile {
  static constexpr auto name = "lsdyna";
  template <class K>
  void describe(K& k) {
    FromFile::describe(k, "path of the .k file, relative to the case file",
                       "titles of parts or element sets: the body is made of them alone; empty: of all");
  }
  /// InputError with file and line.
  Mesh make() const;
};

}  // namespace bw::csd
