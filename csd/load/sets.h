// SPDX-License-Identifier: Apache-2.0
// Named sets of the mesh, or an InputError with the nearest name.
#pragma once
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Where a name was read, for the error: "case.toml:12: nodes".
const std::vector<NodeId>& node_set(const Mesh& mesh, const std::string& name, const std::string& place);
const std::vector<ElemId>& elem_set(const Mesh& mesh, const std::string& name, const std::string& place);
const std::vector<Face>& face_set(const Mesh& mesh, const std::string& name, const std::string& place);
/// The union of several, each face once, in the order of the names.
std::vector<Face> face_sets(const Mesh& mesh, const std::vector<std::string>& names, const std::string& place);

}  // namespace bw::csd
