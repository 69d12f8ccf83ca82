// SPDX-License-Identifier: Apache-2.0
// `mesh = {...}` of a body: kind, and what is done to every kind.
#pragma once
#include <string>
#include <vector>

#include "common/io/keys.h"
#include "csd/mesh/check.h"
#include "csd/mesh/list.h"

namespace bw::csd {

/// Everything inside a brick of space becomes a set; the boundary faces with all nodes inside too.
struct RegionSet {
  std::string name, place;
  Vec3 lower{-1e30, -1e30, -1e30}, upper{1e30, 1e30, 1e30};
  template <class K>
  void describe(K& k) {
    k.required("name", name, "name of the set of nodes, elements and boundary faces");
    k.optional("lower", lower, dim::length, "smallest coordinates (after scale, turn and move)");
    k.optional("upper", upper, dim::length, "largest coordinates");
    if (!k.is_manual()) place = k.where("name");
  }
};

struct MeshInput {
  MeshKind kind;
  double scale = 1, turn = 0, perturb = 0;
  Vec3 turn_axis{0, 0, 1}, move{0, 0, 0};
  int seed = 1;
  bool may_have_pieces = false;
  std::vector<RegionSet> sets;
  std::string place;  // in the case file, for errors
  template <class K>
  void describe(K& k) {
    k.pick("kind", kind,
           "where the mesh comes from. Sets of nodes and faces: box x_lower, x_upper .. z_upper; cylinder lower, "
           "upper, side; tube inner, "
           "outer, lower, upper; sectors cut_x, cut_y or cut_z by the planes' normals; shell_of_revolution and weapon "
           "inner, outer (weapon "
           "also elements nose_plug, base_plug, wall); block as box; ball outer, inner, cut_x .. cut_z; gmsh, abaqus, "
           "lsdyna "
           "the file's own",
           true);
    k.optional("scale", scale, dim::none, "factor on all coordinates (0.001 for a file in millimetres)");
    k.expect(scale > 0, "scale", "a positive factor");
    k.optional("turn", turn, dim::none, "rotation about turn_axis through the origin [degrees], after scale");
    k.optional("turn_axis", turn_axis, dim::none, "axis of `turn`");
    k.expect(norm(turn_axis) > 0, "turn_axis", "a direction");
    k.optional("move", move, dim::length, "shift, after scale and turn");
    k.optional("perturb", perturb, dim::none, "random shift of inner nodes, as a fraction of their shortest edge");
    k.expect(perturb >= 0 && perturb <= 0.5, "perturb", "between 0 and 0.5");
    k.optional("seed", seed, "of the random shifts");
    k.optional("pieces", may_have_pieces, "the mesh may consist of several unconnected pieces");
    k.tables("sets", sets, "further sets, by region");
    if (!k.is_manual()) place = k.where("kind");
  }
};

/// Builds, transforms and checks one body's mesh. InputError as check_mesh and the kinds say.
Mesh make_mesh(const MeshInput& input, MeshQuality& quality);

/// One mesh of several bodies: body = position in the list; ids follow in that order. A set `s` of body `b` is called
/// "b.s", and "s" holds the sets of that name of all bodies; element set "b": all elements of the body.
Mesh merge(std::vector<Mesh> bodies, const std::vector<std::string>& names);

/// Moves nodes off the boundary at random by up to `fraction` of their shortest edge in each direction, less where an
/// element would lose more than half its scaled Jacobian. A function of seed and gids.
void perturb_nodes(Mesh& mesh, double fraction, uint64_t seed);

}  // namespace bw::csd
