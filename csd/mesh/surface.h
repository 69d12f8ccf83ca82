// SPDX-License-Identifier: Apache-2.0
// The wetted surface: chosen parts of the original boundary, and every lip of a crack.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "coupling/surface.h"
#include "csd/mesh/topology.h"

namespace bw::csd {

class Surface {
 public:
  /// Face sets that are wet from the start; none: the whole boundary. InputError "place: ..." if the mesh has no such
  /// set.
  Surface(const Mesh& mesh, const Topology& topology, const std::vector<std::string>& sets, const std::string& place);

  /// Takes over positions [m] and velocities [m/s]; connectivity and topo_version change only if cracks have opened
  /// since the last call. Returns true if they did.
  bool update(const Mesh& mesh, const Topology& topology, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& v);

  /// After a restart: update()s so far, and the version that they led to.
  void go_on_from(int64_t topo_version) { wet_.topo_version = topo_version; }
  /// Quads with normals out of the solid; face_id = elem_gid * 6 + side, node_id = node_gid. Lips follow the original
  /// faces in the order of their birth and carry face_lip.
  const coupling::WetSurface& wet() const { return wet_; }
  coupling::WetSurface& wet() { return wet_; }  ///< v is the caller's until the next update()
  const std::vector<NodeId>& nodes() const { return nodes_; }  ///< mesh node of each wet node, ascending
  const std::vector<Face>& faces() const { return faces_; }    ///< mesh face of each quad
  /// Adds forces on the wet nodes [N] (coupling::nodal_loads) to the mesh's nodes.
  void add_forces(std::span<const Vec3> wet_force, Field<Vec3, NodeId>& f) const;

 private:
  void renew(const Mesh& mesh, const Topology& topology);

  coupling::WetSurface wet_;
  std::vector<NodeId> nodes_;
  std::vector<Face> faces_;
  size_t original_ = 0;          // faces_ that are no lips
  size_t lips_seen_ = 0;         // of topology.boundary()
  int64_t version_ = -1;         // of the topology
  std::vector<int32_t> number_;  // wet number of a mesh node, -1: dry
};

}  // namespace bw::csd
