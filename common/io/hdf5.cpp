// SPDX-License-Identifier: Apache-2.0
#include "common/io/hdf5.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "common/io/file.h"
#include "common/io/hdf5_types.h"
#include "common/parallel/loop.h"

namespace bw::h5 {

namespace {

constexpr int64_t chunk_items = 131072, compress_above = 16384;
constexpr int deflate_level = 1;

/// The innermost entry of HDF5's stack of errors: the cause.
herr_t note_cause(unsigned depth, const H5E_error2_t* entry, void* text) {
  if (depth == 0 && entry->desc) *static_cast<std::string*>(text) = std::string(": ") + entry->desc;
  return 0;
}

/// A chunk of so many items as HDF5's filters shuffle and deflate would leave it; zeros behind what there is.
template <Value T>
std::vector<Bytef> pack_chunk(std::span<const T> there, size_t items) {
  static_assert(std::endian::native == std::endian::little, "as in the file");
  std::vector<T> chunk(there.begin(), there.end());
  chunk.resize(items);
  const auto* bytes = reinterpret_cast<const Bytef*>(chunk.data());
  std::vector<Bytef> shuffled(items * sizeof(T)), packed(compressBound(uLong(shuffled.size())));
  for (size_t b = 0; b < sizeof(T); ++b)
    for (size_t i = 0; i < items; ++i) shuffled[b * items + i] = bytes[i * sizeof(T) + b];
  uLongf size = uLongf(packed.size());
  const bool done = compress2(packed.data(), &size, shuffled.data(), uLong(shuffled.size()), deflate_level) == Z_OK;
  packed.resize(done ? size : 0);
  return packed;
}

Handle access(const std::string& path, const Comm& comm) {
  Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (comm.size() > 1 && H5Pset_fapl_mpio(list.get(), comm.raw(), MPI_INFO_NULL) < 0) failed(path, "parallel access");
  return list;
}

}  // namespace

void failed(const std::string& path, const std::string& what) {
  std::string cause;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_cause, &cause);
  throw std::runtime_error(fmt::format("{}: HDF5: {} failed{}", path, what, cause));
}

void quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Handle Group::owned(hid_t id, Handle::Closer closer, const std::string& what) const {
  if (id < 0) failed(shared_->path, what);
  return Handle(id, closer);
}

void Group::check(herr_t status, const std::string& what) const {
  if (status < 0) failed(shared_->path, what);
}

void File::finish() const { root_.check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "writing it to its end"); }

Handle Group::transfer() const {
  Handle list = owned(H5Pcreate(H5P_DATASET_XFER), H5Pclose, "making a transfer list");
  if (shared_->comm.size() > 1) check(H5Pset_dxpl_mpio(list.get(), H5FD_MPIO_COLLECTIVE), "collective transfer");
  return list;
}

/// On several ranks: room for so many bytes more, and for what HDF5 says about them. A collective write that finds the
/// disk full need not return on all ranks; here all learn of it and fail alike.
void Group::reserve(uint64_t bytes) const {
  if (shared_->comm.size() == 1) return;
  constexpr uint64_t at_first = 1 << 18, each = 1 << 12;  // HDF5's own
  uint64_t& size = shared_->reserved;
  size += bytes + (size == 0 ? at_first : each);
  const int64_t error = shared_->comm.root() ? reserve_file(shared_->path, size) : 0;
  if (const int64_t any = shared_->comm.max(error))
    throw std::runtime_error(
        fmt::format("{}: no room for {} bytes more: {}", shared_->path, bytes, std::strerror(int(any))));
}

File File::create(const std::string& path, const Comm& comm) {
  quiet();
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access(path, comm).get()), H5Fclose);
  if (file.get() < 0) failed(path, "creating the file");
  Group root(std::make_shared<const Group::Shared>(Group::Shared{path, comm, 0}),
             Handle(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose));
  root.reserve(0);
  return File(std::move(file), std::move(root));
}

File File::open(const std::string& path, const Comm& comm) {
  quiet();
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access(path, comm).get()), H5Fclose);
  if (file.get() < 0 && comm.size() == 1)  // its writer is still there, or has died: what a GrowingFile holds is whole
    file = Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, H5P_DEFAULT), H5Fclose);
  if (file.get() < 0) failed(path, "opening the file");
  Group root(std::make_shared<const Group::Shared>(Group::Shared{path, comm, 0}),
             Handle(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose));
  return File(std::move(file), std::move(root));
}

Group Group::group(const std::string& name) const {
  const hid_t id = has(name) ? H5Gopen2(handle_->get(), name.c_str(), H5P_DEFAULT)
                             : H5Gcreate2(handle_->get(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  return Group(shared_, owned(id, H5Gclose, "opening group " + name));
}

bool Group::has(const std::string& name) const { return H5Lexists(handle_->get(), name.c_str(), H5P_DEFAULT) > 0; }

std::vector<std::string> Group::names() const {
  std::vector<std::string> all;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  check(H5Literate(handle_->get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &all), "listing names");
  return all;
}

// --- attributes
// ------------------------------------------------------------------------------------------------------------

template <Value T>
void Group::attribute(const std::string& name, std::span<const T> values) const {
  const hsize_t n = values.size();
  const Handle space = owned(H5Screate_simple(1, &n, nullptr), H5Sclose, "sizing attribute " + name);
  const Handle attribute =
      owned(H5Acreate2(handle_->get(), name.c_str(), file_type<T>(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            "creating attribute " + name);
  check(H5Awrite(attribute.get(), memory_type<T>(), values.data()), "writing attribute " + name);
}

void Group::attribute(const std::string& name, const std::string& text) const {
  const Handle type = owned(H5Tcopy(H5T_C_S1), H5Tclose, "making a text type");
  check(H5Tset_size(type.get(), std::max<size_t>(text.size(), 1)), "sizing text " + name);
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "padding text " + name);
  check(H5Tset_cset(type.get(), H5T_CSET_ASCII), "encoding text " + name);
  const Handle space = owned(H5Screate(H5S_SCALAR), H5Sclose, "sizing attribute " + name);
  const Handle attribute =
      owned(H5Acreate2(handle_->get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            "creating attribute " + name);
  check(H5Awrite(attribute.get(), type.get(), text.c_str()), "writing attribute " + name);
}

template <Value T>
std::vector<T> Group::read_attribute(const std::string& name) const {
  const Handle attribute =
      owned(H5Aopen(handle_->get(), name.c_str(), H5P_DEFAULT), H5Aclose, "opening attribute " + name);
  const Handle space = owned(H5Aget_space(attribute.get()), H5Sclose, "sizing attribute " + name);
  std::vector<T> values(size_t(H5Sget_simple_extent_npoints(space.get())));
  check(H5Aread(attribute.get(), memory_type<T>(), values.data()), "reading attribute " + name);
  return values;
}

std::string Group::read_text_attribute(const std::string& name) const {
  const Handle attribute =
      owned(H5Aopen(handle_->get(), name.c_str(), H5P_DEFAULT), H5Aclose, "opening attribute " + name);
  const Handle type = owned(H5Aget_type(attribute.get()), H5Tclose, "type of attribute " + name);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0)
    failed(shared_->path, "reading text " + name);
  std::string text(H5Tget_size(type.get()), '\0');
  check(H5Aread(attribute.get(), type.get(), text.data()), "reading attribute " + name);
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

// --- arrays
// ----------------------------------------------------------------------------------------------------------------

template <Value T>
void Group::write(const std::string& name, std::span<const T> mine, int columns, Packing packing) const {
  const hsize_t width = hsize_t(columns), rows = mine.size() / width;
  hsize_t before = 0, total = 0;
  const std::vector<uint64_t> all = shared_->comm.gather_all(std::vector<uint64_t>{rows});
  for (int r = 0; r < int(all.size()); ++r) {
    if (r < shared_->comm.rank()) before += all[size_t(r)];
    total += all[size_t(r)];
  }
  reserve(total * width * sizeof(T));
  const int rank = columns == 1 ? 1 : 2;
  const hsize_t dims[2] = {total, width}, start[2] = {before, 0}, count[2] = {rows, width};
  const Handle space = owned(H5Screate_simple(rank, dims, nullptr), H5Sclose, "sizing " + name);
  const Handle layout = owned(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "layout of " + name);
  const hsize_t chunk[2] = {std::min<hsize_t>(total, std::max<hsize_t>(1, hsize_t(chunk_items) / width)), width};
  const bool is_packed = packing == Packing::compressed && int64_t(total * width) > compress_above;
  if (is_packed) {
    check(H5Pset_chunk(layout.get(), rank, chunk), "chunks of " + name);
    check(H5Pset_shuffle(layout.get()), "shuffle of " + name);
    check(H5Pset_deflate(layout.get(), deflate_level), "compression of " + name);
  }
  const Handle set = owned(
      H5Dcreate2(handle_->get(), name.c_str(), file_type<T>(), space.get(), H5P_DEFAULT, layout.get(), H5P_DEFAULT),
      H5Dclose, "creating " + name);
  if (total == 0) return;
  if (is_packed && shared_->comm.size() == 1) {  // by all threads; the library would do it by one
    const size_t items = size_t(chunk[0] * width);
    std::vector<std::vector<Bytef>> chunks((mine.size() + items - 1) / items);
    parallel_for_dynamic(int64_t(chunks.size()), [&](int64_t c) {
      const size_t first = size_t(c) * items;
      chunks[size_t(c)] = pack_chunk(mine.subspan(first, std::min(items, mine.size() - first)), items);
    });
    for (size_t c = 0; c < chunks.size(); ++c) {
      if (chunks[c].empty()) failed(shared_->path, "compressing " + name);
      const hsize_t at[2] = {c * chunk[0], 0};
      check(H5Dwrite_chunk(set.get(), H5P_DEFAULT, 0, at, chunks[c].size(), chunks[c].data()), "writing " + name);
    }
    return;
  }
  const Handle memory = owned(H5Screate_simple(rank, count, nullptr), H5Sclose, "rows of " + name);
  if (rows > 0) {
    check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, count, nullptr), "rows of " + name);
  } else {  // a rank without rows still takes part
    check(H5Sselect_none(space.get()), "rows of " + name);
    check(H5Sselect_none(memory.get()), "rows of " + name);
  }
  check(H5Dwrite(set.get(), memory_type<T>(), memory.get(), space.get(), transfer().get(), mine.data()),
        "writing " + name);
}

std::array<int64_t, 2> Group::shape(const std::string& name) const {
  const Handle set = owned(H5Dopen2(handle_->get(), name.c_str(), H5P_DEFAULT), H5Dclose, "opening " + name);
  const Handle space = owned(H5Dget_space(set.get()), H5Sclose, "size of " + name);
  hsize_t dims[2] = {0, 1};
  if (H5Sget_simple_extent_ndims(space.get()) > 2)
    failed(shared_->path, "reading " + name + " of more than 2 dimensions");
  H5Sget_simple_extent_dims(space.get(), dims, nullptr);
  return {int64_t(dims[0]), int64_t(dims[1])};
}

template <Value T>
std::vector<T> Group::read(const std::string& name, int64_t first, int64_t count) const {
  const auto [rows, width] = shape(name);
  if (count < 0) count = rows - first;
  if (first < 0 || first + count > rows)
    failed(shared_->path, fmt::format("reading rows {} to {} of {} in {}", first, first + count, rows, name));
  std::vector<T> values(size_t(count * width));
  const Handle set = owned(H5Dopen2(handle_->get(), name.c_str(), H5P_DEFAULT), H5Dclose, "opening " + name);
  const Handle space = owned(H5Dget_space(set.get()), H5Sclose, "size of " + name);
  const hsize_t start[2] = {hsize_t(first), 0}, size[2] = {hsize_t(count), hsize_t(width)};
  const Handle memory =
      owned(H5Screate_simple(H5Sget_simple_extent_ndims(space.get()), size, nullptr), H5Sclose, "rows of " + name);
  if (count > 0)
    check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, size, nullptr), "rows of " + name);
  else
    check(H5Sselect_none(space.get()), "rows of " + name);
  check(H5Dread(set.get(), memory_type<T>(), memory.get(), space.get(), H5P_DEFAULT, values.data()), "reading " + name);
  return values;
}

#define BW_INSTANTIATE(T)                                                                    \
  template void Group::attribute<T>(const std::string&, std::span<const T>) const;           \
  template std::vector<T> Group::read_attribute<T>(const std::string&) const;                \
  template void Group::write<T>(const std::string&, std::span<const T>, int, Packing) const; \
  template std::vector<T> Group::read<T>(const std::string&, int64_t, int64_t) const;
BW_INSTANTIATE(double)
BW_INSTANTIATE(float)
BW_INSTANTIATE(int64_t)
BW_INSTANTIATE(int32_t)
BW_INSTANTIATE(uint8_t)
#undef BW_INSTANTIATE

}  // namespace bw::h5
