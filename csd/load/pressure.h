// SPDX-License-Identifier: Apache-2.0
// A pressure that depends on time alone, on named faces, following them.
#pragma once
#include <string>
#include <vector>

#include "csd/load/face_load.h"
#include "csd/load/loaded_faces.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

struct Pressure {
  static constexpr auto name = "pressure";
  Table table;
  std::vector<std::string> faces;
  std::string place;

  template <class K>
  void describe(K& k) {
    k.required("faces", faces, "names of the face sets that are loaded");
    table.describe_with(k, "pressures", dim::pressure, "at these times; linear between, constant outside");
    if (!k.is_manual()) place = k.where("faces");
  }

  void select(const Mesh& mesh) { set_ = {mesh, face_sets(mesh, faces, place)}; }
  void add(const Mesh& mesh, const Field<Vec3, NodeId>& x, const Field<double, NodeId>&, double t,
           Field<Vec3, NodeId>& f) const {
    if (at(t) != 0) set_.add(*this, mesh, x, t, f);
  }
  LoadedFaces& set() { return set_; }
  double at(double t) const { return table.at(t); }
  template <class Force>
  void on_face(size_t, const std::array<Vec3, 4>& x, double p, const Force& force) const {
    add_pressure(x, p, force);
  }

 private:
  LoadedFaces set_;
};

}  // namespace bw::csd
