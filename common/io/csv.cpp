// SPDX-License-Identifier: Apache-2.0
#include "common/io/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "common/app/error.h"
#include "common/io/file.h"

namespace bw {

namespace {

[[noreturn]] void failed(const std::string& path) {
  throw std::runtime_error(fmt::format("{}: cannot be written: {}", path, std::strerror(errno)));
}

std::string header(const std::vector<History::Column>& columns) {
  std::string line;
  for (const auto& c : columns) line += fmt::format("{}{} [{}]", line.empty() ? "" : ",", c.name, c.unit);
  return line + "\n";
}

}  // namespace

History::History(const std::string& path, std::vector<Column> columns) : History(path, std::move(columns), "") {}

History::History(const std::string& path, std::vector<Column> columns, const std::string& rows)
    : path_(path),
      columns_(std::move(columns)),
      rows_(std::count(rows.begin(), rows.end(), '\n')),
      flushed_(std::chrono::steady_clock::now()) {
  write_atomically(path_, header(columns_) + rows);
  file_ = std::fopen(path_.c_str(), "ab");
  if (!file_) failed(path_);
}

template <class Kept>
History History::resume_where(const std::string& path, std::vector<Column> columns, const Kept& kept_row) {
  std::ifstream in(path, std::ios::binary);
  std::string kept, line;
  std::getline(in, line);
  const std::string old_header = line + "\n";
  for (int64_t i = 0; std::getline(in, line) && !in.eof(); ++i)  // a last row without its end was cut by a crash
    if (kept_row(line, i)) kept += line + "\n";
  in.close();
  const std::string expected = header(columns);
  if (old_header != expected)
    throw InputError(fmt::format("{}: its columns are not those of this case; expected {}", path, expected));
  return History(path, std::move(columns), kept);
}

History History::resume(const std::string& path, std::vector<Column> columns, double t) {
  return resume_where(path, std::move(columns),
                      [&](const std::string& line, int64_t) { return std::strtod(line.c_str(), nullptr) <= t; });
}

History History::resume_rows(const std::string& path, std::vector<Column> columns, int64_t rows) {
  if (!std::filesystem::exists(path)) return History(path, std::move(columns));
  History resumed = resume_where(path, std::move(columns), [&](const std::string&, int64_t i) { return i < rows; });
  if (resumed.rows() < rows)
    throw InputError(
        fmt::format("{}: has {} rows, but the checkpoint was written after {}: another run's, or an older one", path,
                    resumed.rows(), rows));
  return resumed;
}

History::History(History&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(std::move(other.columns_)),
      file_(std::exchange(other.file_, nullptr)),
      rows_(other.rows_),
      flushed_(other.flushed_) {}

History::~History() {
  if (file_) std::fclose(file_);
}

void History::row(std::span<const double> values) {
  if (values.size() != columns_.size())
    throw std::logic_error(fmt::format("{}: a row of {} values for {} columns", path_, values.size(), columns_.size()));
  std::string line;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw PhysicsError(fmt::format("{}: {} is {} in the row of {} = {:.12g}", path_, columns_[i].name, values[i],
                                     columns_[0].name, values[0]));
    line += fmt::format("{}{:.12g}", i ? "," : "", values[i]);
  }
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size()) failed(path_);
  ++rows_;
  if (std::chrono::steady_clock::now() - flushed_ > std::chrono::seconds(1)) flush();
}

void History::flush() {
  if (std::fflush(file_) != 0) failed(path_);
  flushed_ = std::chrono::steady_clock::now();
}

}  // namespace bw
