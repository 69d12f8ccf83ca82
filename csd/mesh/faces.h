// SPDX-License-Identifier: Apache-2.0
// Which faces of a mesh lie on each other, and sets made from that.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

/// A face as one number, elem * 6 + side; -1: none.
inline int32_t face_code(Face f) { return f.elem.valid() ? f.elem * 6 + f.side : -1; }
inline Face face_of(int32_t code) { return code < 0 ? Face{} : Face{ElemId(code / 6), code % 6}; }

/// For each element and side the code of the face with the same four nodes, -1 on the boundary.
/// InputError "where: ..." if three or more faces coincide.
Field<std::array<int32_t, 6>, ElemId> pair_faces(const Mesh& mesh, const std::string& where = "mesh");

/// Faces without a partner, by element and side.
std::vector<Face> boundary_faces(const Mesh& mesh, const std::string& where = "mesh");

/// Node set and face set `name`: the nodes for which `holds` is true, and the boundary faces that have no other nodes.
void add_set(Mesh& mesh, const std::vector<Face>& boundary, const std::string& name,
             const std::function<bool(NodeId)>& holds);

/// The nodes of a face set, ascending.
std::vector<NodeId> nodes_of_faces(const Mesh& mesh, const std::vector<Face>& faces);

/// Sum of area vectors and enclosed volume of the faces [m^2, m^3] with the outward normals of their elements at
/// positions x.
struct FaceSum {
  Vec3 area;
  double area_norm = 0;  ///< sum of |A|
  double volume = 0;
};
FaceSum sum_faces(const Mesh& mesh, const Field<Vec3, NodeId>& x, const std::vector<Face>& faces);

/// True if every edge of the faces belongs to exactly two of them, run through once each way.
bool is_closed(const Mesh& mesh, const std::vector<Face>& faces);

}  // namespace bw::csd
