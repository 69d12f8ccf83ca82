// SPDX-License-Identifier: Apache-2.0
// The pieces that the mesh has fallen into: elements that hang together by shared nodes.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "csd/mesh/mesh.h"

namespace bw::csd {

struct Fragment {
  int64_t id = 0,
          parent = -1;  ///< ids are never used again; parent: the fragment that it broke off, -1: there from the start
  double birth = 0;     ///< s
  int32_t body = 0;
  int64_t elements = 0;
  double mass = 0, volume = 0;                                     ///< kg, m^3 (current)
  Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};  ///< m, bounding box
  Vec3 centroid, velocity;                                         ///< m, m/s, of the mass
  Vec3 angular_momentum, spin;                                     ///< kg m^2/s about the centroid, 1/s
  double kinetic_energy = 0, eqps = 0;                             ///< J; mean over the reference volume
};

class Fragments {
 public:
  /// The pieces of the uncracked mesh, born at t [s].
  Fragments(const Mesh& mesh, double t);

  /// To be called when cracks have opened since the last call; t [s] becomes the birth time of what broke off. Of the
  /// parts of a fragment the one of the largest reference volume (then the lowest elem_gid) keeps its id. Returns true
  /// if there are more now.
  bool relabel(const Mesh& mesh, double t);

  int count() const { return int(known_.size()); }
  /// Place of the element's fragment in the list, which is ordered by id.
  const Field<int32_t, ElemId>& label() const { return label_; }
  int64_t id(int label) const { return known_[size_t(label)].id; }
  double birth(int label) const { return known_[size_t(label)].birth; }  ///< s

  /// Everything about the fragments at positions x [m], velocities v [m/s], lumped masses m [kg] of the nodes and mean
  /// equivalent plastic strain of the elements.
  std::vector<Fragment> table(const Mesh& mesh, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& v,
                              const Field<double, NodeId>& m, std::span<const double> eqps) const;

 private:
  struct Known {
    int64_t id, parent;
    double birth;
  };
  Field<double, ElemId> volume_;  // reference
  Field<int32_t, ElemId> label_;
  std::vector<Known> known_;
  int64_t next_id_ = 0;
};

/// For each element the lowest element that it hangs together with by shared nodes.
Field<ElemId, ElemId> pieces_by_nodes(const Mesh& mesh);

/// Replaces the file: one row a fragment, ordered by id, header with units. std::runtime_error if it can't be written.
void write_fragments(const std::string& path, double t, std::span<const Fragment> fragments);

}  // namespace bw::csd
