// SPDX-License-Identifier: Apache-2.0
// The mark that makes two files of two programs one checkpoint of the pair: <folder>/pair_checkpoint_00000123.txt, of
// window 123, written by the solid when both files are complete and on the disk. A pair goes on from the latest mark;
// files that no mark names were never agreed on.
#pragma once
#include <cstdint>
#include <string>

namespace bw::coupling {

struct CommitMark {
  int64_t window = 0;        ///< the next one
  double t = 0;              ///< s, where it starts
  std::string solid, fluid;  ///< names of the files; in the mark's folder
  int64_t solid_bytes = 0, fluid_bytes = 0;
  std::string folder = {};  ///< of the mark, as read or to be written

  std::string solid_path() const { return folder + "/" + solid; }
  std::string fluid_path() const { return folder + "/" + fluid; }
  /// FNV-1a of the mark's text: compared in HELLO.
  uint64_t hash() const;
};

/// Sets the sizes; the mark is on the disk when it returns. Then all but the latest `keep` marks of the folder are
/// removed, and the checkpoints of both programs that none of these names. One rank calls.
void commit(CommitMark mark, int keep);
/// The mark itself, or the latest of a folder. InputError if there is none, or if a file that it names is not there in
/// the size that it had.
CommitMark find_commit(const std::string& file_or_folder);

}  // namespace bw::coupling
