// SPDX-License-Identifier: Apache-2.0
// A force per area of fixed direction (dead load): it neither turns nor grows with its faces.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "csd/load/face_load.h"
#include "csd/load/loaded_faces.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

struct Traction {
  static constexpr auto name = "traction";
  Vec3 traction{}, total{};
  std::vector<std::string> faces;
  std::optional<Table> factor;
  std::string place;

  template <class K>
  void describe(K& k) {
    k.required("faces", faces, "names of the face sets that are loaded");
    k.optional("traction", traction, dim::pressure, "force per area of the faces as they were at the start");
    k.optional("total", total, dim::force, "in place of `traction`: the whole force, shared out by area");
    describe_factor(k, factor);
    k.expect((norm(traction) > 0) != (norm(total) > 0), "traction", "either `traction` or `total`, and not zero");
    if (!k.is_manual()) place = k.where("faces");
  }

  void select(const Mesh& mesh) {
    set_ = {mesh, face_sets(mesh, faces, place)};
    share_.clear();
    double area = 0;
    for (Face face : set_) {
      const auto n = mesh.nodes_of(face);
      const auto shares = area_shares({mesh.X[n[0]], mesh.X[n[1]], mesh.X[n[2]], mesh.X[n[3]]});
      std::array<double, 4> sizes;
      for (size_t a = 0; a < 4; ++a) area += sizes[a] = norm(shares[a]);
      share_.push_back(sizes);
    }
    per_area_ = norm(total) > 0 ? (1 / area) * total : traction;
  }
  void add(const Mesh& mesh, const Field<Vec3, NodeId>& x, const Field<double, NodeId>&, double t,
           Field<Vec3, NodeId>& f) const {
    set_.add(*this, mesh, x, t, f);
  }
  LoadedFaces& set() { return set_; }
  Vec3 at(double t) const { return (factor ? factor->at(t) : 1.0) * per_area_; }
  template <class Force>
  void on_face(size_t i, const std::array<Vec3, 4>&, const Vec3& now, const Force& force) const {
    for (size_t a = 0; a < 4; ++a) force(a) += share_[i][a] * now;
  }

 private:
  LoadedFaces set_;
  std::vector<std::array<double, 4>> share_;  // m^2 of each node of the faces
  Vec3 per_area_{};                           // Pa
};

}  // namespace bw::csd
