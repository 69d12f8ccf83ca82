// SPDX-License-Identifier: Apache-2.0
// Checkpoints of the fluid: everything from which a run goes on bit for bit, on any number of ranks and threads. Blocks
// at rest are kept as one cell.
#pragma once
#include <optional>
#include <string>

#include "cfd/books.h"
#include "common/app/checkpoint_clock.h"
#include "common/io/checkpoint.h"

namespace bw::cfd {

class Output;

/// A checkpoint that a run begins from.
struct Restart {
  CheckpointHead head;
  CheckpointReader file;
};
/// What `cs.restart` names; none if it is empty. InputError if it is no checkpoint of this case.
std::optional<Restart> open_restart(const Case& cs, const Comm& comm);

/// Writes <output.directory>/fluid_checkpoint_<step>.h5 and removes older ones. Collective.
void write_checkpoint(const Case& cs, const Model& m, const Books& books, Output& out, int keep);

/// The grid, the flow and what was known at the start; walls, if there are any, from `surface`. Instead of paint().
void restore_model(Model& m, const Restart& from, const coupling::WetSurface* surface);
/// After restore_model and Books::fit.
void restore_books(Books& books, const Comm& comm, const Restart& from);

}  // namespace bw::cfd
