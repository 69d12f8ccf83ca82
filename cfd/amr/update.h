// SPDX-License-Identifier: Apache-2.0
// The end of a block's step: U_new = U + change, burn, traces of a material removed, limits of the state checked, and
// what the next step needs to know about the block.
#pragma once
#include "cfd/medium.h"
#include "cfd/scheme/block_kernel.h"
#include "cfd/source/burn.h"
#include "cfd/state.h"

namespace bw::cfd {

/// Volume fractions below this are removed, so that blocks become one-material again.
inline constexpr double alpha_trace = 1e-8;

struct UpdateInput {
  const Medium* medium = nullptr;
  const Burn* burn = nullptr;  ///< nullptr: no burn anywhere
  bool burns = false;          ///< lambda changes in this block
  double t0 = 0, t1 = 0;       ///< the step [s]
  bool last_try = false;       ///< p below its floor is lifted (and booked) instead of marked
  /// One gas: the spare copy's rows of other materials and of volume fractions are those of the state.
  bool others_hold = false;
  const uint8_t* blocked = nullptr;  ///< [cell] cells that hold no fluid: left as they are; nullptr: none
  double heat = 0;                   ///< J/kg that material 1 releases in the step besides the burn: booked
};

struct UpdateResult {
  BlockInfo info;
  int gas = 0;         ///< 1, 2 ...: all open cells were updated as this gas alone
  int64_t bad = 0;     ///< cells whose state can't be used; marked
  int first_bad = -1;  ///< the first of them
};

/// U: the block's current copy; change: U_new - U (rows that the flow doesn't own: unchanged, see material); out: the
/// spare copy. marks: [cell] set to 1 where the new state is bad (allocated by the first such cell). booked: added to.
UpdateResult update_block(const UpdateInput& in, const Patch& patch, const double* U, const BlockChange& change,
                          double* out, std::vector<uint8_t>& marks, Booked& booked);

/// The same without a change: what a state just made (initial, refilled) looks like.
BlockInfo inspect_block(const Medium& medium, const BlockShape& shape, const Vec3& lower, const double* U,
                        const uint8_t* blocked);

}  // namespace bw::cfd
