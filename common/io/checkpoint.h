// SPDX-License-Identifier: Apache-2.0
// Checkpoints: one HDF5 file per program and step, from which a run goes on bit for bit.
//
//   <folder>/<program>_checkpoint_00001234.h5      program: "fluid" or "solid"; the number is that of the step
//   attributes of the root: program, layout, case (hash of the case), step, t [s], ranks
//
//   CheckpointWriter out(path, head, comm);        // every rank calls every function in the same order
//   Saved flow = out.section("flow");
//   flow.rows("U", U, columns);                    // this rank's rows: the file holds all ranks', one after the other
//   flow.same("times", times);                     // what all ranks hold alike
//   out.finish();                                  // closed, synced, renamed: never half a file
//
//   CheckpointReader in(path, head, comm);         // InputError if it is of another program, layout or case
//   Restored flow = in.section("flow");
//   U = flow.rows<double>("U", first, count);  times = flow.same<double>("times");
#pragma once
#include <concepts>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "common/io/hdf5.h"

namespace bw {

struct CheckpointHead {
  std::string program;    ///< "fluid", "solid"
  int64_t layout = 1;     ///< version of what the program writes; another one can't be read
  std::string case_hash;  ///< case_hash() below
  int64_t step = 0;       ///< written; when reading, set from the file
  double t = 0;           ///< s, likewise
  int64_t ranks = 1;      ///< that wrote it, likewise
};

/// What a case file says about the physics, as 16 hexadecimal digits: all of it but [time], [output], [checkpoint],
/// the title and `threads`, none of which changes the results up to a time. Comments, order and blanks don't count.
/// InputError if the file is no TOML.
std::string case_hash(const std::string& case_file);

/// A record of plain data is kept as its bytes.
template <class T>
concept Record = std::is_trivially_copyable_v<T> && !h5::Value<T>;

/// One group of a checkpoint being written.
class Saved {
 public:
  Saved(h5::Group group, const Comm& comm) : group_(std::move(group)), comm_(comm) {}
  template <h5::Value T>
  void rows(const std::string& name, const std::vector<T>& mine, int columns = 1) const {
    group_.write(name, std::span<const T>(mine), columns, h5::Group::Packing::plain);
  }
  template <Record T>
  void rows(const std::string& name, const std::vector<T>& mine) const {
    rows(name, bytes_of(mine), int(sizeof(T)));
  }
  template <class T>
  void same(const std::string& name, const std::vector<T>& values) const {
    rows(name, comm_.root() ? values : std::vector<T>());
  }
  template <class T>
  void number(const std::string& name, const T& value) const {
    same(name, std::vector<T>{value});
  }
  Saved section(const std::string& name) const { return Saved(group_.group(name), comm_); }
  const Comm& comm() const { return comm_; }

 private:
  template <Record T>
  static std::vector<uint8_t> bytes_of(const std::vector<T>& values) {
    std::vector<uint8_t> bytes(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
  }
  h5::Group group_;
  Comm comm_;
};

/// One group of a checkpoint being read. InputError if a name is missing.
class Restored {
 public:
  Restored(h5::Group group, std::string path) : group_(std::move(group)), path_(std::move(path)) {}
  bool has(const std::string& name) const { return group_.has(name); }
  /// Rows of all ranks together.
  int64_t count(const std::string& name) const { return need(name)[0]; }
  /// Rows [first, first + count); count -1: to the end.
  template <h5::Value T>
  std::vector<T> rows(const std::string& name, int64_t first = 0, int64_t count = -1) const {
    need(name);
    return group_.read<T>(name, first, count);
  }
  template <Record T>
  std::vector<T> rows(const std::string& name, int64_t first = 0, int64_t count = -1) const {
    need(name, int64_t(sizeof(T)));
    const std::vector<uint8_t> bytes = group_.read<uint8_t>(name, first, count);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return values;
  }
  template <class T>
  std::vector<T> same(const std::string& name) const {
    return rows<T>(name);
  }
  template <class T>
  T number(const std::string& name) const {
    return rows<T>(name, 0, 1).at(0);
  }
  Restored section(const std::string& name) const;

 private:
  std::array<int64_t, 2> need(const std::string& name, int64_t columns = -1) const;
  h5::Group group_;
  std::string path_;
};

class CheckpointWriter {
 public:
  /// Collective, as all members. The file is at `path` after finish() only.
  CheckpointWriter(const std::string& path, const CheckpointHead& head, const Comm& comm);
  Saved section(const std::string& name) const { return Saved(file_->root().group(name), comm_); }
  void finish();

 private:
  std::string path_;
  Comm comm_;
  std::optional<h5::File> file_;
};

class CheckpointReader {
 public:
  /// head: program, layout and case that the run has; step, t and ranks are set from the file.
  CheckpointReader(const std::string& path, CheckpointHead& head, const Comm& comm);
  Restored section(const std::string& name) const;
  bool has(const std::string& name) const { return file_.root().has(name); }

 private:
  std::string path_;
  h5::File file_;
};

/// Where the checkpoint of a step goes.
std::string checkpoint_path(const std::string& folder, const std::string& program, int64_t step);
/// The file itself, or the latest complete checkpoint of the program in a folder; step >= 0: that of this step.
/// InputError if there is none.
std::string find_checkpoint(const std::string& file_or_folder, const std::string& program, int64_t step = -1);
/// Removes all but the latest `keep` of the program's checkpoints in a folder. One rank calls.
void drop_old_checkpoints(const std::string& folder, const std::string& program, int keep);

}  // namespace bw
