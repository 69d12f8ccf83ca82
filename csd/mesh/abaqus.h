// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Nodes, elements and sets of an Abaqus input file with one part: *NODE, *ELEMENT (C3D8 and kin; C3D4, split into four
/// hexahedra), *NSET and *ELSET (also GENERATE), *SURFACE of element faces. Other keywords are passed over; elements
/// without volume are left out with a note.
struct Abaqus {
  std::string file;
  std::vector<std::string> elements;
  static constexpr auto name = "abaqus";
  template <class K>
  void describe(K& k) {
    k.required("file", file, "path of the .inp file, relative to the case file");
    k.optional("elements", elements, "names of element sets: the body is made of them alone; empty: of all");
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
