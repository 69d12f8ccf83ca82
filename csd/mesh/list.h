// SPDX-License-Identifier: Apache-2.0
// The kinds of meshes. A new one: one header and one word here.
#pragma once
#include <concepts>
#include <variant>

#include "csd/mesh/abaqus.h"
#include "csd/mesh/block.h"
#include "csd/mesh/box.h"
#include "csd/mesh/cylinder.h"
#include "csd/mesh/gmsh.h"
#include "csd/mesh/lsdyna.h"
#include "csd/mesh/shell.h"

namespace bw::csd {

template <class M>
concept MeshMaker = requires(const M& m) {
  M::name;
  { m.make() } -> std::same_as<Mesh>;
};

using MeshKind = std::variant<Box, Block, Cylinder, Tube, Ball, ShellOfRevolution, Weapon, Gmsh, Abaqus, LsDyna>;

template <MeshMaker... Ms>
constexpr bool all_make_meshes(const std::variant<Ms...>*) {
  return true;
}
static_assert(all_make_meshes(static_cast<const MeshKind*>(nullptr)));

}  // namespace bw::csd
