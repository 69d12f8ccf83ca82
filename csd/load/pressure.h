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
    const double p = table.at(t);
    if (p == 0) return;
    set_.for_each(mesh, x, f, [&](size_t i) {
      const auto n = mesh.nodes_of(set_[i]);
      add_pressure(n, {x[n[0]], x[n[1]], x[n[2]], x[n[3]]}, p, f);
    });
  }

 private:
  LoadedFaces set_;
};

}  // namespace bw::csd
