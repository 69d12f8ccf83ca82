// SPDX-License-Identifier: Apache-2.0
// Who touches whom: partners of faces and elements of nodes, kept valid while cracks split nodes.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "csd/mesh/faces.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// A node that a crack split off: the child took over some elements of the parent.
struct NodeSplit {
  NodeId parent, child;
  friend bool operator==(const NodeSplit&, const NodeSplit&) = default;
};

class Topology {
 public:
  explicit Topology(const Mesh& mesh, const std::string& where = "mesh");

  /// Face on the other side while all four nodes are shared; invalid elem on the boundary and across cracks.
  Face neighbour(Face f) const { return is_bonded(f) ? partner(f) : Face{}; }
  /// Face that lay on the other side in the uncracked mesh; invalid elem on the original boundary.
  Face partner(Face f) const { return face_of(partner_[f.elem][size_t(f.side)]); }
  bool is_bonded(Face f) const { return bonds_[f.elem] >> f.side & 1; }
  /// Elements of a node, ascending.
  std::span<const ElemId> elements(NodeId n) const {
    const Star& s = star_[n];
    return {pool_.data() + s.first, size_t(s.count)};
  }
  /// Faces of the original boundary by element and side, then lips of cracks in the order of birth.
  const std::vector<Face>& boundary() const { return boundary_; }
  int original_boundary_count() const { return original_; }
  bool is_lip(Face f) const { return partner_[f.elem][size_t(f.side)] >= 0; }  ///< of a boundary face
  /// Increases with every split that is made.
  int64_t version() const { return version_; }

  /// Number of groups into which the elements of a node fall when only bonded faces that contain the node join them.
  int star_parts(const Mesh& mesh, NodeId n) const;
  /// The same, with the group of each element of elements(n); groups are numbered by their first element.
  int star_parts(const Mesh& mesh, NodeId n, std::vector<int>& part) const;

  /// Gives `elems` (ascending, some but not all elements of `parent`) a new node in place of `parent`: mesh and
  /// adjacency are changed, the mesh's nodal arrays and node sets grow by one. Faces that lose their bond are appended
  /// to boundary().
  NodeId split(Mesh& mesh, NodeId parent, std::span<const ElemId> elems);

  /// For tests: the first violation found of: eight distinct nodes an element; elements(n) as the connectivity says;
  /// partners symmetric; bonded = four shared nodes; every star in one part; closed boundary. Empty: all well.
  std::string find_fault(const Mesh& mesh) const;

 private:
  struct Star {
    int32_t first = 0, count = 0;
  };
  void renew_bonds(const Mesh& mesh, ElemId e);

  Field<std::array<int32_t, 6>, ElemId> partner_;
  Field<uint8_t, ElemId> bonds_;  // bit per side
  Field<Star, NodeId> star_;
  std::vector<ElemId> pool_;  // elements of nodes; a split leaves its part at the end of the parent's to the child
  std::vector<Face> boundary_;
  int original_ = 0;
  int64_t version_ = 0;
  Field<int32_t, NodeId> membership_;                  // index into memberships_
  std::vector<std::vector<std::string>> memberships_;  // node sets that a node is in; 0: none
};

}  // namespace bw::csd
