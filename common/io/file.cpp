// SPDX-License-Identifier: Apache-2.0
#include "common/io/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "common/app/error.h"

namespace bw {

namespace {

[[noreturn]] void failed(const std::string& path) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

}  // namespace

void rename_finished(const std::string& temporary, const std::string& path) {
  const int file = open(temporary.c_str(), O_RDONLY);
  if (file < 0) failed(temporary);
  const bool synced = fsync(file) == 0;
  close(file);
  if (!synced || std::rename(temporary.c_str(), path.c_str()) != 0) failed(path);
}

int reserve_file(const std::string& path, uint64_t size) {
  const int file = open(path.c_str(), O_WRONLY);
  if (file < 0) return errno;
  const int error = fallocate(file, 0, 0, off_t(size)) == 0 ? 0 : errno;
  close(file);
  return error == EOPNOTSUPP || error == ENOSYS ? 0 : error;  // not every file system can tell beforehand
}

void write_atomically(const std::string& path, const std::string& text) {
  const std::string temporary = path + ".tmp";
  std::FILE* out = std::fopen(temporary.c_str(), "wb");
  if (!out) failed(path);
  const bool written = std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if (std::fclose(out) != 0 || !written) failed(path);
  rename_finished(temporary, path);
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path))
    throw InputError(
        fmt::format("output.directory: \"{}\" cannot be created{}", path, error ? ": " + error.message() : ""));
}

}  // namespace bw
