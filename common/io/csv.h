// SPDX-License-Identifier: Apache-2.0
// Tables over time: one header row "t [s],kinetic_energy [J],...", then rows of numbers at 12 significant digits.
#pragma once
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <vector>

namespace bw {

class History {
 public:
  struct Column {
    std::string name, unit;  ///< unit "1": a plain number
  };
  /// Creates the file, or replaces it. Throws std::runtime_error if it can't be written.
  History(const std::string& path, std::vector<Column> columns);
  /// Goes on with the file after a restart: rows whose first column is above t are dropped. InputError if its columns
  /// differ.
  static History resume(const std::string& path, std::vector<Column> columns, double t);
  /// The same by number: the first `rows` rows stay. A file that is absent (another folder) begins anew.
  static History resume_rows(const std::string& path, std::vector<Column> columns, int64_t rows);
  History(History&& other) noexcept;
  History& operator=(History&&) = delete;
  ~History();

  /// One value per column. PhysicsError if one is NaN or infinite: names column and row. Reaches the disk within a
  /// second.
  void row(std::span<const double> values);
  void row(std::initializer_list<double> values) { row(std::span(values.begin(), values.size())); }
  void flush();
  int64_t rows() const { return rows_; }  ///< in the file
  const std::vector<Column>& columns() const { return columns_; }

 private:
  std::string path_;
  std::vector<Column> columns_;
  /// With the rows that it holds already, each with its end of line.
  History(const std::string& path, std::vector<Column> columns, const std::string& rows);
  /// kept(line, its number) of the old file's rows.
  template <class Kept>
  static History resume_where(const std::string& path, std::vector<Column> columns, const Kept& kept);
  std::FILE* file_ = nullptr;
  int64_t rows_ = 0;
  std::chrono::steady_clock::time_point flushed_;
};

}  // namespace bw
