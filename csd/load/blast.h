// SPDX-License-Identifier: Apache-2.0
// Empirical air blast of a charge on named faces, without a fluid: arrival, overpressure, decay and angle of incidence
// by the distance of each face at the start; no shielding, no suction phase.
#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

#include "common/app/error.h"
#include "common/math/units.h"
#include "csd/load/face_load.h"
#include "csd/load/kingery_bulmash.h"
#include "csd/load/loaded_faces.h"
#include "csd/load/sets.h"

namespace bw::csd {

struct Blast {
  static constexpr auto name = "blast";
  Vec3 centre{};
  double charge = 0, equivalent = 1, start_time = 0;
  std::string burst = "free_air", place;
  std::vector<std::string> faces;

  template <class K>
  void describe(K& k) {
    k.required("faces", faces, "names of the face sets that are loaded");
    k.required("centre", centre, dim::length, "of the charge");
    k.required("charge", charge, dim::mass, "mass of the explosive");
    k.optional("tnt_equivalent", equivalent, dim::none, "mass of TNT that does what a unit of the explosive does");
    k.choice(
        "burst", burst, {"free_air", "hemispherical"},
        "free_air: a sphere far from any ground; hemispherical: a half sphere on rigid ground. Kingery and Bulmash, "
        "valid to 40 m/kg^(1/3)");
    k.optional("start_time", start_time, dim::time,
               "of the detonation; may be negative, so that the blast has nearly "
               "arrived at t = 0");
    k.expect(charge > 0, "charge", "a positive mass");
    k.expect(equivalent > 0, "tnt_equivalent", "a positive number");
    if (!k.is_manual()) place = k.where("faces");
  }

  void select(const Mesh& mesh) {
    const BlastCurves& curves = burst == "free_air" ? free_air::curves : hemisphere::curves;
    set_ = {mesh, face_sets(mesh, faces, place)};
    wave_.clear();
    for (Face face : set_) {
      const auto n = mesh.nodes_of(face);
      const double distance = norm(centre_of({mesh.X[n[0]], mesh.X[n[1]], mesh.X[n[2]], mesh.X[n[3]]}) - centre);
      const double Z = distance / std::cbrt(equivalent * charge);
      if (Z < curves.nearest || Z > farthest_blast)
        throw InputError(
            fmt::format("{}: a face of element {} is at {:.4g} m/kg^(1/3) from the charge; the curves hold "
                        "from {} to {}",
                        place, mesh.elem_gid[face.elem], Z, curves.nearest, farthest_blast));
      wave_.push_back(BlastWave::at(curves, distance, equivalent * charge));
    }
  }
  void add(const Mesh& mesh, const Field<Vec3, NodeId>& x, const Field<double, NodeId>&, double t,
           Field<Vec3, NodeId>& f) const {
    set_.add(*this, mesh, x, t, f);
  }
  LoadedFaces& set() { return set_; }
  double at(double t) const { return t - start_time; }
  template <class Force>
  void on_face(size_t i, const std::array<Vec3, 4>& x, double since, const Force& force) const {
    if (since < wave_[i].arrival || since >= wave_[i].arrival + wave_[i].duration) return;
    const Vec3 area = cross(x[2] - x[0], x[3] - x[1]), ray = centre_of(x) - centre;
    const double cosine = -dot(area, ray) / (norm(area) * norm(ray));
    add_pressure(x, wave_[i].pressure(cosine, since), force);
  }

 private:
  LoadedFaces set_;
  std::vector<BlastWave> wave_;  // per face
};

}  // namespace bw::csd
