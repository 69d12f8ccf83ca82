// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "csd/mesh/from_file.h"

namespace bw::csd {

/// Nodes, elements and sets of an Abaqus input file with one part: *NODE, *ELEMENT (C3D8 and kin; C3D4, split into four
/// hexahedra), *NSET and *ELSET (also GENERATE), *SURFACE of element faces, *INCLUDE. Other keywords are passed over;
/// elements without volume are left out with a note.
struct Abaqus : FromFile {
  static constexpr auto name = "abaqus";
  template <class K>
  void describe(K& k) {
    FromFile::describe(k, "path of the .inp file, relative to the case file",
                       "names of element sets: the body is made of them alone; empty: of all");
  }
  /// InputError with file and line.
  Mesh make() const;
};

}  // namespace bw::csd
