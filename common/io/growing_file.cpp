// SPDX-License-Identifier: Apache-2.0
#include "common/io/growing_file.h"

#include <algorithm>

#include "common/io/hdf5_types.h"

namespace bw::h5 {

GrowingFile::GrowingFile(const std::string& path) : path_(path) {
  quiet();
  const Handle list(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  check(H5Pset_libver_bounds(list.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST) >= 0, "choosing a version");
  file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, list.get()), H5Fclose);
  check(file_.get() >= 0, "creating the file");
}

void GrowingFile::check(bool well, const std::string& what) const {
  if (!well) failed(path_, what);
}

template <Value T>
void GrowingFile::table(const std::string& name, int64_t columns) {
  constexpr hsize_t chunk_bytes = 65536;
  const int rank = columns == 1 ? 1 : 2;
  const hsize_t none[2] = {0, hsize_t(columns)}, most[2] = {H5S_UNLIMITED, hsize_t(columns)};
  const hsize_t chunk[2] = {std::max<hsize_t>(1, chunk_bytes / (hsize_t(columns) * sizeof(T))), hsize_t(columns)};
  const Handle space(H5Screate_simple(rank, none, most), H5Sclose), list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(space.get() >= 0 && H5Pset_chunk(list.get(), rank, chunk) >= 0, "planning " + name);
  Table& t = tables_[name];
  t.columns = columns;
  t.data =
      Handle(H5Dcreate2(file_.get(), name.c_str(), file_type<T>(), space.get(), H5P_DEFAULT, list.get(), H5P_DEFAULT),
             H5Dclose);
  check(t.data.get() >= 0, "making " + name);
}

void GrowingFile::start() { check(H5Fstart_swmr_write(file_.get()) >= 0, "opening it for readers"); }

template <Value T>
void GrowingFile::append(const std::string& name, std::span<const T> rows) {
  Table& t = tables_.at(name);
  if (rows.empty()) return;
  const int rank = t.columns == 1 ? 1 : 2;
  const hsize_t first[2] = {hsize_t(t.rows), 0},
                count[2] = {hsize_t(rows.size()) / hsize_t(t.columns), hsize_t(t.columns)};
  t.rows += int64_t(count[0]);
  const hsize_t size[2] = {hsize_t(t.rows), hsize_t(t.columns)};
  check(H5Dset_extent(t.data.get(), size) >= 0, "making room in " + name);
  const Handle space(H5Dget_space(t.data.get()), H5Sclose), memory(H5Screate_simple(rank, count, nullptr), H5Sclose);
  check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, first, nullptr, count, nullptr) >= 0, "rows of " + name);
  check(H5Dwrite(t.data.get(), memory_type<T>(), memory.get(), space.get(), H5P_DEFAULT, rows.data()) >= 0,
        "writing " + name);
}

void GrowingFile::flush() { check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, "writing it to its end"); }

#define BW_INSTANTIATE(T)                                           \
  template void GrowingFile::table<T>(const std::string&, int64_t); \
  template void GrowingFile::append<T>(const std::string&, std::span<const T>);
BW_INSTANTIATE(double)
BW_INSTANTIATE(int64_t)
BW_INSTANTIATE(int32_t)
BW_INSTANTIATE(uint8_t)
#undef BW_INSTANTIATE

}  // namespace bw::h5
