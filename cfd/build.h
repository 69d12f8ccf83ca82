// SPDX-License-Identifier: Apache-2.0
// From a case to a flow at t = 0.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cfd/case.h"
#include "cfd/embed/walls.h"
#include "cfd/sweep.h"

namespace bw::cfd {

struct Start;

/// Everything of a run. Address-stable: its parts point at each other.
struct Model {
  Model(const Comm& comm, const Case& cs);
  Model(const Model&) = delete;

  Forest forest;
  State state;
  FlowSetup setup;
  std::optional<RefineRules> refine;  ///< none: a uniform grid
  WallOptions wall_options;
  std::optional<Walls> walls;    ///< embedded surface, if there is one
  std::optional<Bodies> bodies;  ///< stand-alone: what moves it
  std::shared_ptr<const Start> start;  ///< another run's end that this one begins with (cfd/start/paint.h); nullptr: none
  bool afterburn_follows = false;  ///< the products burn on when the programmed burn is over
  std::string afterburn_place;     ///< in the case file
  double explosive_mass = 0;     ///< kg, at t = 0
  double cavity_mass = 0;        ///< kg: exact volume of the cavities times the density painted into them; 0: none
};

/// The walls' lattice is the forest's. p_ref [Pa]: on faces that see no fluid.
void add_walls(Model& m, double p_ref);
/// Paints the regions of the case and checks the burn against them. Cavities need the walls' map.
void paint(Model& m, const Case& cs);
/// What is known of each block, from its cells. Covered cells do not count.
void inspect(Model& m, const std::vector<int>& blocks);
/// Parts of a block's cells that hold fluid, [k][j][i]; empty if blocked_cells() tells all.
std::vector<double> open_volumes(const Model& m, int block);
/// Cells of a block that hold no fluid: [k][j][i] flags; empty if all do.
std::vector<uint8_t> blocked_cells(const Model& m, int block);

}  // namespace bw::cfd
