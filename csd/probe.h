// SPDX-License-Identifier: Apache-2.0
// Columns of solid_history.csv that the user asks for.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "common/io/csv.h"
#include "common/math/units.h"
#include "csd/load/sets.h"

namespace bw::csd {

struct Physics;
struct State;

/// The node nearest to a place in the reference configuration.
struct NodeProbe {
  static constexpr auto name = "node";
  Vec3 position{};
  template <class K>
  void describe(K& k) {
    k.required("position", position, dim::length, "of the node: the nearest one at the start is taken");
  }
  void select(const Mesh& mesh, const Physics&);
  std::vector<History::Column> columns() const {
    return {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"vx", "m/s"}, {"vy", "m/s"}, {"vz", "m/s"}};
  }
  void values(const Mesh& mesh, const State& s, const Physics& ph, std::vector<double>& out);

 private:
  NodeId node_;
};

/// The element whose centroid is nearest to a place in the reference configuration.
struct ElementProbe {
  static constexpr auto name = "element";
  Vec3 position{};
  template <class K>
  void describe(K& k) {
    k.required("position", position, dim::length,
               "of the element: the one with the nearest centroid at the start is taken");
  }
  void select(const Mesh& mesh, const Physics&);
  std::vector<History::Column> columns() const {
    std::vector<History::Column> c{{"J", "1"},         {"eqps", "1"},      {"sigma_m", "Pa"},  {"von_mises", "Pa"},
                                   {"sigma_xx", "Pa"}, {"sigma_yy", "Pa"}, {"sigma_zz", "Pa"}, {"sigma_xy", "Pa"},
                                   {"sigma_xz", "Pa"}, {"sigma_yz", "Pa"}};
    if (heats_) c.push_back({"temperature", "K"});
    return c;
  }
  void values(const Mesh& mesh, const State& s, const Physics& ph, std::vector<double>& out);

 private:
  ElemId elem_;
  bool heats_ = false;
};

/// Means over the nodes that stood in a slab across an axis at the start, weighted by mass.
struct RingProbe {
  static constexpr auto name = "ring";
  Vec3 axis{0, 0, 1}, centre{};
  double lower = -1e30, upper = 1e30;
  std::string nodes, place;
  template <class K>
  void describe(K& k) {
    k.optional("axis", axis, dim::none, "direction of the axis (of any length)");
    k.optional("centre", centre, dim::length, "a point of the axis, from which lower and upper count");
    k.optional("lower", lower, dim::length, "where the slab begins along the axis; not given: no bound");
    k.optional("upper", upper, dim::length, "where it ends");
    k.optional("nodes", nodes, "name of a node set; empty: all nodes");
    k.expect(norm(axis) > 0, "axis", "a direction other than (0, 0, 0)");
    k.expect(upper > lower, "upper", "more than lower");
    if (!k.is_manual()) place = k.where("kind");
  }
  void select(const Mesh& mesh, const Physics&);
  std::vector<History::Column> columns() const {
    return {{"radius", "m"}, {"radius_max", "m"}, {"v_radial", "m/s"}, {"v_axial", "m/s"}, {"z", "m"}};
  }
  void values(const Mesh& mesh, const State& s, const Physics& ph, std::vector<double>& out);

 private:
  std::vector<NodeId> nodes_;  // with the children that cracks gave them
  std::vector<char> is_in_;    // per node known so far
};

/// Force that the body puts on a rigid wall (or what a fixed, roller or velocity condition bears): the mean over the
/// last step.
struct WallForceProbe {
  static constexpr auto name = "wall_force";
  int condition = 0;
  std::string place;
  template <class K>
  void describe(K& k) {
    k.optional("condition", condition, "number of the [[solid.condition]], the first is 0");
    if (!k.is_manual()) place = k.where("kind");
  }
  void select(const Mesh& mesh, const Physics& ph);
  std::vector<History::Column> columns() const { return {{"fx", "N"}, {"fy", "N"}, {"fz", "N"}}; }
  void values(const Mesh& mesh, const State& s, const Physics& ph, std::vector<double>& out);
};

using ProbeKind = std::variant<NodeProbe, ElementProbe, RingProbe, WallForceProbe>;

struct ProbeCase {
  std::string name;
  ProbeKind kind;
  template <class K>
  void describe(K& k) {
    k.required("name", name, "columns are called \"name quantity\"");
    k.expect(!name.empty() && name.find_first_of(",\"\r\n") == std::string::npos, "name",
             "a name without commas, quotes and line ends");
    k.pick("kind", kind, "probe", true);
  }
};

}  // namespace bw::csd
