// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "common/app/error.h"
#include "csd/load/conditions/fixed.h"

namespace bw::csd {

/// A plane of symmetry: the nodes that lie on it at the start slide on it. The model stands on one side of it.
struct Symmetry : OnPlane {
  static constexpr auto name = "symmetry";
  Vec3 point{};
  std::string place;

  template <class K>
  void describe(K& k) {
    k.required("normal", normal, dim::none, "of the plane (of any length and sign)");
    k.optional("point", point, dim::length, "a point of the plane");
    k.expect(norm(normal) > 0, "normal", "a direction other than (0, 0, 0)");
    if (!k.is_manual()) place = k.where("normal"), normal = unit(normal);
  }
  void select(const Mesh& mesh) {
    double below = 0, above = 0;
    const auto height = [&](NodeId n) { return dot(mesh.X[n] - point, normal); };
    for (int n = 0; n < mesh.node_count(); ++n)
      below = std::min(below, height(NodeId(n))), above = std::max(above, height(NodeId(n)));
    const double tolerance = 1e-7 * (above - below);
    if (std::min(-below, above) > tolerance)
      throw InputError(
          fmt::format("{}: the model stands on both sides of the plane of symmetry (from {:.6g} to {:.6g} "
                      "m along the normal)",
                      place, below, above));
    std::vector<NodeId> set;
    for (int n = 0; n < mesh.node_count(); ++n)
      if (std::fabs(height(NodeId(n))) <= tolerance) set.push_back(NodeId(n));
    if (set.empty()) throw InputError(place + ": no node lies on the plane of symmetry");
    reaction.renew(set, size_t(mesh.node_count()));
  }
};

}  // namespace bw::csd
