// SPDX-License-Identifier: Apache-2.0
// Cracks by node disconnection, eq (16): a face is opened by giving the element's side of it new nodes.
#pragma once
#include <span>
#include <vector>

#include "csd/mesh/topology.h"

namespace bw::csd {

/// Nodes that the two sides of a once bonded face still share: 0 (open, or no face lay there) to 4 (bonded).
int shared_nodes(const Mesh& mesh, const Topology& topology, Face f);

/// Normal of an element's face at the positions x (not normalised); a node younger than x lies where its parent does.
Vec3 face_area(const Mesh& mesh, Face f, std::span<const Vec3> x);

/// The face of an element that opens, eq (16): of those still joined somewhere, the one with the largest n.sigma.n, the
/// lowest side among equals (1e-9). -1 if no joined face is in tension: nothing opens under compression.
int choose_face(const Mesh& mesh, const Topology& topology, ElemId e, std::span<const Vec3> x, const Sym3& sigma);

/// Opens a face, eq (16): each of its nodes ip that both sides still share is renewed in all elements that contain the
/// edge (ip, jp) into the element. Then every node whose elements no longer hang together by faces is split into its
/// parts, so that no hinges remain. Appends the splits in order and the elements that got new nodes (with repetitions).
/// Work does not grow with the mesh. Returns the number of splits; 0 if there is nothing to separate.
int detach_face(Mesh& mesh, Topology& topology, Face f, std::vector<NodeSplit>& splits, std::vector<ElemId>& changed);

}  // namespace bw::csd
