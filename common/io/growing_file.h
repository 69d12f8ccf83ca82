// SPDX-License-Identifier: Apache-2.0
// An HDF5 file of tables that grow row by row while a run goes on. What was there at the last flush() can be read,
// however the program ends, and while it runs (h5::File::open; h5py.File(name, swmr=True)). One rank writes.
#pragma once
#include <map>

#include "common/io/hdf5.h"

namespace bw::h5 {

class GrowingFile {
 public:
  /// Creates or empties the file; the tables come next, then rows.
  explicit GrowingFile(const std::string& path);
  /// An empty table of rows of `columns` numbers each.
  template <Value T>
  void table(const std::string& name, int64_t columns);
  /// No more tables after this.
  void start();
  /// rows.size() is a multiple of the table's columns.
  template <Value T>
  void append(const std::string& name, std::span<const T> rows);
  /// All rows so far are with the system, rows before the last flush() certainly so.
  void flush();

 private:
  struct Table {
    Handle data;
    int64_t columns = 0, rows = 0;
  };
  void check(bool well, const std::string& what) const;

  std::string path_;
  Handle file_;
  std::map<std::string, Table> tables_;
};

}  // namespace bw::h5
