// SPDX-License-Identifier: Apache-2.0
// Keyword files that stand for others: *INCLUDE.
#pragma once
#include <string>

#include "csd/mesh/mesh_file.h"

namespace bw::csd {

/// abaqus: *INCLUDE, INPUT=name. lsdyna: names on the lines after *INCLUDE, and *END ends a file.
enum class IncludeStyle { abaqus, lsdyna };

/// file.text becomes the text of `path` with those of the files that it includes in their places, file.at() knows where
/// each line stands. Names are relative to the including file's folder. InputError at `place`, or in the file that asks
/// for one that can't be opened or is being read already.
void read_with_includes(const std::string& path, const std::string& place, IncludeStyle style, MeshFile& file);

}  // namespace bw::csd
