// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "csd/element/hex.h"
#include "csd/load/sets.h"
#include "csd/load/table.h"

namespace bw::csd {

/// A force per volume of the elements as they were at the start.
struct BodyForce {
  static constexpr auto name = "body_force";
  Vec3 density{};
  std::string elements, place;
  std::optional<Table> factor;

  template <class K>
  void describe(K& k) {
    k.required("density", density, Dim{1, -2, -2, 0}, "force per reference volume");
    k.optional("elements", elements, "name of the element set (or body); empty: all elements");
    describe_factor(k, factor);
    if (!k.is_manual()) place = k.where("elements");
  }

  void select(const Mesh& mesh) {
    set_.clear(), share_.clear();
    for (int e = 0; elements.empty() && e < mesh.elem_count(); ++e) set_.push_back(ElemId(e));
    if (!elements.empty()) set_ = elem_set(mesh, elements, place);
    for (ElemId e : set_) {
      const auto& h = mesh.hex[e];
      Corners<double> X;
      for (size_t a = 0; a < 8; ++a) X.a[a] = mesh.X[h[a]];
      share_.push_back(row_sums(X));
    }
  }
  void add(const Mesh& mesh, const Field<Vec3, NodeId>&, const Field<double, NodeId>&, double t,
           Field<Vec3, NodeId>& f) const {
    const Vec3 now = (factor ? factor->at(t) : 1.0) * density;
    for (size_t i = 0; i < set_.size(); ++i)
      for (size_t a = 0; a < 8; ++a) f[mesh.hex[set_[i]][a]] += share_[i][a] * now;
  }

 private:
  std::vector<ElemId> set_;
  std::vector<std::array<double, 8>> share_;  // m^3: integrals of the nodes' shape functions
};

}  // namespace bw::csd
