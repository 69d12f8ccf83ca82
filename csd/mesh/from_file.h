// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Keys of a mesh that is read from a file, whatever its format.
struct FromFile {
  std::string file;                   ///< path
  std::vector<std::string> elements;  ///< names of groups that the body is made of; empty: all
  std::string place;                  ///< of the key `file`, for errors

  template <class K>
  void describe(K& k, const char* file_doc, const char* elements_doc) {
    k.required("file", file, file_doc);
    k.optional("elements", elements, elements_doc);
    if (!k.is_manual()) {
      place = k.where("file");
      file = k.resolve_path(file);
    }
  }
};

}  // namespace bw::csd
