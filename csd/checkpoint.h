// SPDX-License-Identifier: Apache-2.0
// Checkpoints of csd: what the case doesn't say of the state of a run, so that it goes on bit for bit, with any number
// of threads and ranks. The model is built from the case as ever; the cracks that it had are opened again, split by
// split, which grows whatever follows the mesh; then all numbers are replaced by the saved ones.
#pragma once
#include <optional>

#include "common/io/checkpoint.h"
#include "coupling/substeps.h"
#include "csd/case.h"
#include "csd/model.h"

namespace bw::csd {

class Coupled;
class Output;

/// Where the run stands between two steps.
struct Progressed {
  double dt = 0;  ///< s, the step that the case asks for
  coupling::EqualSubsteps sub;
};

struct Restart {
  CheckpointHead head;
  CheckpointReader file;
};
/// The checkpoint in a file or the latest in a folder; nothing if that is empty. InputError if it doesn't fit the case.
std::optional<Restart> open_restart(const Case& cs, const std::string& file_or_folder, const Comm& comm);
/// Into a model that build() has just made. InputError if the checkpoint is of another mesh.
Progressed restore_model(Model& model, const Restart& from);

/// Into the case's folder, coupled or not (null). Collective. Returns its path.
std::string write_checkpoint(const Case& cs, Model& model, const Progressed& run, Output& out, Coupled* coupled);
/// One of a run alone: older ones than the latest `keep` are removed.
void write_checkpoint_alone(const Case& cs, Model& model, const Progressed& run, Output& out, int keep);

}  // namespace bw::csd
