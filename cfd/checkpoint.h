// SPDX-License-Identifier: Apache-2.0
// Checkpoints of the fluid: everything from which a run goes on bit for bit, on any number of ranks and threads. Blocks
// at rest are kept as one cell.
#pragma once
#include <optional>
#include <string>

#include "cfd/books.h"
#include "common/app/checkpoint_clock.h"
#include "common/io/checkpoint.h"
#include "coupling/wall_path.h"

namespace bw::cfd {

class Output;

/// A checkpoint that a run begins from.
struct Restart {
  CheckpointHead head;
  CheckpointReader file;
};
/// In a file, or the latest in a folder; none if that is empty. InputError if it is no checkpoint of this case.
std::optional<Restart> open_restart(const Case& cs, const std::string& file_or_folder, const Comm& comm);

/// Writes <output.directory>/fluid_checkpoint_<step>.h5; path: the walls' of a coupled run, or null. Collective. Returns
/// the file's name.
std::string write_checkpoint(const Case& cs, const Model& m, const Books& books, Output& out, coupling::WallPath* path);
/// One of a run alone: all but the latest `keep` are removed.
void write_checkpoint_alone(const Case& cs, const Model& m, const Books& books, Output& out, int keep);

/// The grid, the flow and what was known at the start; walls, if there are any, from `surface`. Instead of paint().
void restore_model(Model& m, const Restart& from, const coupling::WetSurface* surface);
/// The walls of a coupled run: their surface, for restore_model, and where they are.
coupling::WetSurface restore_surface(const Restart& from, coupling::WallPath& path);
/// After restore_model and Books::fit.
void restore_books(Books& books, const Comm& comm, const Restart& from);

}  // namespace bw::cfd
