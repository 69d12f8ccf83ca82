// SPDX-License-Identifier: Apache-2.0
// Blocks through one step: gather, kernel, update, on all threads. A step writes spare copies only, so it can be
// repeated with first-order fluxes at marked cells, or thrown away; commit() makes it the state.
#pragma once
#include <memory>
#include <optional>

#include "cfd/amr/criteria.h"
#include "cfd/amr/flux_register.h"
#include "cfd/amr/gather.h"
#include "cfd/amr/update.h"
#include "cfd/cut/kernel.h"
#include "cfd/embed/walls.h"
#include "cfd/amr/radial.h"
#include "cfd/scheme/block_kernel.h"
#include "cfd/scheme/many_kernel.h"
#include "cfd/source/afterburn.h"
#include "common/parallel/fixed_sum.h"

namespace bw::cfd {

/// What the flow is made of and bounded by; constant during a run.
struct FlowSetup {
  Medium medium;
  Boundary boundary;
  std::optional<Burn> burn;
  std::optional<Afterburn> afterburn;  ///< its share moves on with the steps
  bool skip_quiet = true;  ///< leave out blocks in which nothing can happen (same bits either way)
};

/// Where a step failed for good.
struct BadCell {
  int block = -1, cell = -1;
};

/// What moving walls took from the fluid and gave to it: cells covered and uncovered (DESIGN 5b: booked, not given
/// back).
struct Swept {
  FixedSum lost[Cons::most] = {}, made[Cons::most] = {};  ///< integrals of U
  int64_t covered = 0, fresh = 0;                         ///< cells
};

class Sweep {
 public:
  /// walls: nullptr if there are none; probes get their loads in advance().
  Sweep(const Forest& forest, const FlowSetup& setup, Walls* walls);

  /// The forest has other blocks now.
  void fit();
  /// Copies of other ranks' blocks and their info: before select() and advance().
  void exchange(State& s) const {
    if (walls_ && walls_->cut())  // one gas everywhere; blocks without open cells don't know
      for (int b = 0; b < forest_.local_blocks(); ++b) s.info[size_t(b)].material = 1;
    exchange_state(forest_, s);
  }
  /// Energy per mass that products release in the next step by burning on [J/kg].
  void burn_on(double heat) { heat_ = heat; }
  /// Chooses the blocks of a step of size dt.
  void select(const State& s, double dt);
  /// The next step also notes what the flow at its start asks of the grid (rules; nullptr: it does not).
  void look(const RefineRules* rules) { look_ = rules; }
  /// What the last step noted, [local block]; nullptr: nothing.
  const std::vector<Asks>* asks() const { return look_ ? &asks_ : nullptr; }
  /// Steps the chosen blocks.
  void advance(State& s);
  /// Cells with a state that can't be used, on all ranks.
  int64_t bad() const { return bad_; }
  /// Steps the blocks around bad cells again, first order there.
  void repeat_first_order(State& s);
  /// The step counts.
  void commit(State& s);
  /// The first bad cell of this rank.
  BadCell first_bad() const;
  /// Largest sum_d (|v_d| + c)/h_d over all ranks, with what a burning front will need until t + its answer.
  double max_rate(const State& s) const;
  const std::vector<int>& active() const { return active_; }
  /// Time that a thread has spent on faces between levels, mean over the threads [s].
  double seconds_between_levels() const;
  /// How many blocks the last step did.
  size_t stepped() const { return stepped_; }
  /// What the fluid gave to the walls in the step, all ranks.
  WallExchange wall_exchange() const;
  /// What each cut link gave in the step, in the global order of blocks, all ranks; of walls whose loads are
  /// conservative.
  std::vector<LinkLoad> link_loads() const;
  /// Loads of all probes from the state as it is (advance() makes those of mid-step).
  void measure_loads(const State& s);
  /// Gives the cells that the walls' last motion freed a state; ghosts are exchanged between layers. `changed`: blocks
  /// whose sums change.
  void refill(State& s, std::vector<int>& changed, Swept& swept);

 private:
  struct Space {
    Patch patch;
    LevelGhosts ghosts;
    BlockChange change;
    std::optional<BlockKernel<GasFlow, Pack>> gas;
    std::optional<BlockKernel<MixedFlow, Pack>> mixed;
    std::unique_ptr<ManyKernel> many;  ///< of more than two materials
    RadialSpace radial;
    PatchCuts cuts;
    std::unique_ptr<CutScheme> cut_gas[most_materials], cut_mixed;  ///< made when there are walls
    std::optional<CutCellKernel> cut_cell;             ///< in their place
    std::vector<uint8_t> blocked;
  };
  enum Near : uint8_t { far, near, metal };
  bool is_gas(const Patch& patch) const { return patch.material != 0 && setup_.medium.is_gas[patch.material - 1]; }
  /// Which blocks take the kernel of one gas, other ranks' too; where some may and others may not.
  void share_kernels(const Gather& gather);
  /// No damping (cfd/scheme/carbuncle.h) at faces shared with blocks whose kernel has none: both give one flux.
  void match_kernels(int block, Patch& patch) const;
  CutScheme& cut_scheme(Space& space) const {
    return is_gas(space.patch) ? *space.cut_gas[space.patch.material - 1] : *space.cut_mixed;
  }
  /// Of a block near walls, before its kernel runs; nullptr: none in its patch.
  const CutFaces* cut_faces(int block, Space& space);
  /// Corrects the change beside walls, loads the block's probes; returns the cells without fluid, nullptr if there are
  /// none. cut: cut_faces() had any.
  const uint8_t* meet_walls(const State& s, int block, bool cut, Space& space);
  /// The end of the step of cut cells and those around them, in the spare copies.
  void mix_cut_cells(State& s);
  void load_probes(int block, Space& space, double dt);
  void run_blocks(State& s, const std::vector<int>& blocks, bool first_order);
  void one_block(State& s, int block, bool first_order, Space& space);
  /// Replaces fluxes to finer neighbours by theirs, keeps those to coarser ones.
  void match_levels(int block, Space& space);
  void rest_at_sides(const State& s, int block, Booked& booked) const;
  std::vector<int> around_marked() const;
  bool burns(int block) const;
  void count_bad();
  void note(const double (&U)[Cons::most], BlockInfo& info) const;

  const Forest& forest_;
  const FlowSetup& setup_;
  Walls* walls_;
  double t_ = 0, dt_ = 0, heat_ = 0;
  FluxRegister fluxes_;
  std::vector<int> active_;
  size_t stepped_ = 0;
  const RefineRules* look_ = nullptr;
  std::vector<Asks> asks_;  ///< [local block]
  std::vector<UpdateResult> result_;  ///< [local block]
  std::vector<int8_t> gas_before_;    ///< [local block] 1, 2 ...: the gas that its last step was done for; 0: not one gas
  std::vector<Booked> pending_;       ///< [local block] of this step
  std::vector<std::vector<uint8_t>> marks_;        ///< [local block] bad cells of the last pass
  std::vector<std::vector<uint8_t>> first_order_;  ///< [local block] cells stepped first order
  std::vector<Near> near_;                         ///< [local block]
  std::vector<uint8_t> lone_gas_;  ///< [local block, then other ranks'] takes the kernel of one gas; empty: all alike
  std::vector<WallExchange> wall_;                 ///< [local block] of this step
  std::vector<std::vector<LinkLoad>> links_;       ///< [local block] of this step; of conservative loads
  std::vector<uint8_t> ghost_marks_;               ///< of other ranks' blocks, when any rank has marks
  std::vector<int64_t> cut_bad_;                   ///< [local block] bad cells of mix_cut_cells()
  int64_t bad_ = 0;
  std::vector<Space> spaces_;
};

}  // namespace bw::cfd
