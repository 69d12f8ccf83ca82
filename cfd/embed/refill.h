// SPDX-License-Identifier: Apache-2.0
// The state of a cell that the walls have just uncovered or passed over, from connected cells on its own side.
#pragma once
#include <functional>

#include "cfd/embed/cut_map.h"
#include "cfd/mix/list.h"

namespace bw::cfd {

/// Least density and pressure of a fresh cell in shares of its neighbour's.
inline constexpr double refill_share = 1e-3;

/// Conserved state of a cell of the lattice; called for cells up to three away from the fresh one.
using CellReader = std::function<void(const Index3& cell, double* U)>;

/// U of a fresh cell: mean over the directions with a valid neighbour A (open, not fresh, link not cut),
/// - wall on the other side: on the line from the wall's state (half-Riemann of the gas at A, prolonged through B
///   behind it) to A, inside the range of the two, with weight n_d^2;
/// - else the line through B and A prolonged, or A; with a small weight.
/// The density is from A's isentrope, off it by no more than A is off B's and B off that of the next cell (what an
/// impulsive start did to the entropy beside the wall would grow otherwise).
/// Composition comes from the neighbour of the largest weight and neighbours like it: nothing is mixed.
/// false: it has no valid neighbour.
bool refill(const CutMap& map, const Index3& cell, const Mixture& mixture, const Floors& floors, const CellReader& read,
            double* U);

}  // namespace bw::cfd
