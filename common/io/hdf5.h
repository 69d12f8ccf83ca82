// SPDX-License-Identifier: Apache-2.0
// HDF5 files, owned and checked: groups, attributes, 1-D and 2-D arrays of double, float, int64, int32, uint8.
//
//   h5::File file = h5::File::create("a.h5", comm);          // every rank of comm calls every function in the same
//   order file.root().group("solid").write("x", std::span<const double>(x), 3);
//
// On several ranks an array is the ranks' rows one after the other; attributes and groups are the same on all.
// Failures are std::runtime_error with the file's name. Not thread-safe.
#pragma once
#include <hdf5.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/parallel/mpi.h"

namespace bw::h5 {

/// An HDF5 id that closes itself.
class Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Handle(Handle&& other) noexcept : id_(other.id_), closer_(other.closer_) { other.id_ = -1; }
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(closer_, other.closer_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) closer_(id_);
  }
  hid_t get() const { return id_; }

 private:
  hid_t id_ = -1;
  Closer closer_ = nullptr;
};

/// The types that arrays and attributes may have.
template <class T>
concept Value = std::same_as<T, double> || std::same_as<T, float> || std::same_as<T, int64_t> ||
    std::same_as<T, int32_t> || std::same_as<T, uint8_t>;

class Group {
 public:
  Group group(const std::string& name) const;  ///< opened, or created
  bool has(const std::string& name) const;
  std::vector<std::string> names() const;  ///< of groups and arrays, in alphabetic order

  /// Attributes: one-dimensional, or a text of fixed length (ASCII), as VTK's readers want them.
  template <Value T>
  void attribute(const std::string& name, std::span<const T> values) const;
  template <Value T>
  void attribute(const std::string& name, T value) const {
    attribute(name, std::span<const T>(&value, 1));
  }
  void attribute(const std::string& name, const std::string& text) const;
  template <Value T>
  std::vector<T> read_attribute(const std::string& name) const;
  std::string read_text_attribute(const std::string& name) const;

  enum class Packing { plain, compressed };
  /// This rank's rows of `columns` numbers each; 1: a one-dimensional array. Large arrays are compressed (chunks,
  /// shuffle, gzip 1) unless plain.
  template <Value T>
  void write(const std::string& name, std::span<const T> mine, int columns = 1, Packing packing = Packing::compressed) const;
  template <Value T>
  void write(const std::string& name, const std::vector<T>& mine, int columns = 1) const {
    write(name, std::span<const T>(mine), columns);
  }
  /// {rows, columns} of the whole array; columns 1 if it is one-dimensional.
  std::array<int64_t, 2> shape(const std::string& name) const;
  /// Rows [first, first + count) of the whole array, converted to T; count -1: to its end. Each rank may ask for its
  /// own.
  template <Value T>
  std::vector<T> read(const std::string& name, int64_t first = 0, int64_t count = -1) const;

 private:
  friend class File;
  struct Shared {
    std::string path;
    Comm comm;
    mutable uint64_t reserved;  // bytes, so far
  };
  Group(std::shared_ptr<const Shared> shared, Handle handle)
      : shared_(std::move(shared)), handle_(std::make_shared<Handle>(std::move(handle))) {}
  Handle owned(hid_t id, Handle::Closer closer, const std::string& what) const;
  void check(herr_t status, const std::string& what) const;
  void reserve(uint64_t bytes) const;
  Handle transfer() const;  // collective on several ranks, as compressed arrays need it
  std::shared_ptr<const Shared> shared_;
  std::shared_ptr<Handle> handle_;
};

class File {
 public:
  /// Created, or emptied. A Comm of one rank (the default) needs no MPI.
  static File create(const std::string& path, const Comm& comm = {});
  static File open(const std::string& path, const Comm& comm = {});  ///< read only
  Group root() const { return root_; }
  /// All that was written is with the system; std::runtime_error if it isn't (a full disk), which closing alone doesn't
  /// tell. Collective.
  void finish() const;

 private:
  File(Handle file, Group root) : file_(std::move(file)), root_(std::move(root)) {}
  Handle file_;
  Group root_;
};

}  // namespace bw::h5
