// SPDX-License-Identifier: Apache-2.0
// The pieces that the mesh has fallen into: elements that hang together by shared nodes.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "csd/mesh/topology.h"

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
  double temperature = 0;                                          ///< K, likewise; 0: the material has none
  Vec3 sides;          ///< m, of the box with the same second moments of volume: length, width, thickness
  double surface = 0;  ///< m^2, faces with no neighbour
  bool is_rigid = false;
  double left = -1;  ///< s, when it was retired beyond the given box, -1: it is there

  /// Mean presented area over mass^(2/3) [m^2/kg^(2/3)]; the area is a quarter of the surface, which is exact for
  /// convex bodies [Cauchy].
  double shape_factor() const;
  /// visit(name, unit, value) of every column of the table; value: int64_t or double.
  template <class Visit>
  void describe(Visit&& visit) const {
    const auto vector = [&](std::array<const char*, 3> names, const char* unit, const Vec3& value) {
      for (int d = 0; d < 3; ++d) visit(names[size_t(d)], unit, value[d]);
    };
    visit("id", "1", id);
    visit("parent", "1", parent);
    visit("birth", "s", birth);
    visit("body", "1", int64_t(body));
    visit("elements", "1", elements);
    visit("mass", "kg", mass);
    visit("volume", "m^3", volume);
    vector({"lower_x", "lower_y", "lower_z"}, "m", lower);
    vector({"upper_x", "upper_y", "upper_z"}, "m", upper);
    vector({"x", "y", "z"}, "m", centroid);
    vector({"v_x", "v_y", "v_z"}, "m/s", velocity);
    vector({"L_x", "L_y", "L_z"}, "kg m^2/s", angular_momentum);
    vector({"spin_x", "spin_y", "spin_z"}, "1/s", spin);
    visit("kinetic_energy", "J", kinetic_energy);
    visit("eqps", "1", eqps);
    visit("temperature", "K", temperature);
    vector({"length", "width", "thickness"}, "m", sides);
    visit("surface", "m^2", surface);
    visit("shape_factor", "m^2/kg^(2/3)", shape_factor());
    visit("rigid", "1", int64_t(is_rigid));
    visit("left", "s", left);
  }
};

/// What the table is made of, at one time.
struct FragmentFields {
  const Field<Vec3, NodeId>&x, &v;              ///< m, m/s
  const Field<double, NodeId>& m;               ///< kg, lumped
  std::span<const double> eqps, temperature{};  ///< [element] means; no temperature: empty
  std::span<const char> is_rigid{};             ///< [node]; those beyond are not
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

  /// Everything about the fragments, ordered by id.
  std::vector<Fragment> table(const Mesh& mesh, const Topology& topology, const FragmentFields& fields) const;

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.list("label", label_), a.list("known", known_), a.value("next_id", next_id_);
  }

 private:
  struct Known {
    int64_t id, parent;
    double birth;
  };
  std::vector<ElemId> cut_elements(const Mesh& mesh);

  Field<double, ElemId> volume_;  // reference
  Field<int32_t, ElemId> label_;
  std::vector<Known> known_;
  int64_t next_id_ = 0;
  int32_t nodes_ = 0;  // of the mesh at the last look; too few only cost time
};

/// For each element the lowest element that it hangs together with by shared nodes.
Field<ElemId, ElemId> pieces_by_nodes(const Mesh& mesh);

/// Side lengths, falling, of the box whose second moments about its centre are these per volume [m^2].
Vec3 box_of(const Mat3& second_moments);

/// Replaces PATH.csv and PATH.h5 (one array a column, their units as attributes of its group): one row a fragment.
/// std::runtime_error if they can't be written.
void write_fragments(const std::string& path, double t, std::span<const Fragment> fragments);

}  // namespace bw::csd
