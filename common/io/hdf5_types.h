// SPDX-License-Identifier: Apache-2.0
// What the HDF5 files of this folder share.
#pragma once
#include "common/io/hdf5.h"

namespace bw::h5 {

template <Value T>
hid_t memory_type() {
  if constexpr (std::same_as<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::same_as<T, float>) return H5T_NATIVE_FLOAT;
  if constexpr (std::same_as<T, int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::same_as<T, int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::same_as<T, uint8_t>) return H5T_NATIVE_UINT8;
}
template <Value T>
hid_t file_type() {
  if constexpr (std::same_as<T, double>) return H5T_IEEE_F64LE;
  if constexpr (std::same_as<T, float>) return H5T_IEEE_F32LE;
  if constexpr (std::same_as<T, int64_t>) return H5T_STD_I64LE;
  if constexpr (std::same_as<T, int32_t>) return H5T_STD_I32LE;
  if constexpr (std::same_as<T, uint8_t>) return H5T_STD_U8LE;
}

/// HDF5 prints its own stack of errors unless told not to.
void quiet();
/// std::runtime_error with the file, what was tried, and HDF5's cause.
[[noreturn]] void failed(const std::string& path, const std::string& what);

}  // namespace bw::h5
