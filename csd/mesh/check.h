// SPDX-License-Identifier: Apache-2.0
// What a mesh must satisfy before the first step, and how good it is.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

struct MeshQuality {
  int nodes = 0, elements = 0, pieces = 0;
  int mended = 0;  ///< elements whose node order was wrong and was mended
  int poor = 0;    ///< elements with a scaled Jacobian below 0.2
  double min_scaled_jacobian = 0, median_scaled_jacobian = 0, min_edge = 0, max_edge = 0;  // -, -, m, m
  double volume = 0;                                                                       ///< m^3
  std::array<int, 10> histogram{};  ///< elements by scaled Jacobian: below 0.1, .. 0.2, ... 1
  struct Worst {
    int64_t gid;
    double scaled_jacobian;
    Vec3 centre;
  };
  std::vector<Worst> worst;        ///< up to five elements below 0.5, the worst first
  double cavity_volume = 0;        ///< m^3 enclosed by the face set `inner`, 0 if that is not closed
  std::vector<std::string> notes;  ///< for the log, one line each
};

/// Node orders that occur in files: right, mirrored, lexicographic (i fastest), lexicographic and mirrored.
inline constexpr int known_node_order[4][8] = {
    {0, 1, 2, 3, 4, 5, 6, 7}, {0, 3, 2, 1, 4, 7, 6, 5}, {0, 1, 3, 2, 4, 5, 7, 6}, {0, 2, 3, 1, 4, 6, 7, 5}};
/// The first of them that makes a valid hexahedron of these corners, -1: none.
int valid_node_order(const std::array<Vec3, 8>& corners);

/// Puts elements with a known wrong node order right (mirrored, lexicographic). Returns their number; InputError naming
/// the first element for which no order gives positive Jacobians at all integration points. `where` starts the message.
int mend_node_order(Mesh& mesh, const std::string& where);

/// All checks; InputError if there are no elements, an element uses a node twice or one that does not exist, two
/// elements have the same nodes, an element is inverted, three share a face, a node belongs to no element or joins
/// elements by a point or an edge only, or the mesh has several unconnected pieces without `may_have_pieces`.
MeshQuality check_mesh(Mesh& mesh, const std::string& where, bool may_have_pieces);

/// One line for the log.
std::string summary(const MeshQuality& quality);
/// Lines for the log: histogram of the scaled Jacobian unless all elements are above 0.9; the worst elements.
std::vector<std::string> quality_report(const MeshQuality& quality);

}  // namespace bw::csd
