// SPDX-License-Identifier: Apache-2.0
// Line by line through a keyword file (Abaqus, LS-DYNA), and numbers in its fields, with the place of every error.
#pragma once
#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "common/app/error.h"
#include "csd/mesh/mesh_file.h"

namespace bw::csd {

inline std::string_view trimmed(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
  return s;
}
inline std::string upper(std::string_view s) {
  std::string u(s);
  for (char& c : u) c = char(std::toupper(static_cast<unsigned char>(c)));
  return u;
}
inline std::vector<std::string_view> split_at_commas(std::string_view line) {
  std::vector<std::string_view> fields;
  size_t begin = 0;
  for (size_t i = 0; i <= line.size(); ++i)
    if (i == line.size() || line[i] == ',') fields.push_back(trimmed(line.substr(begin, i - begin))), begin = i + 1;
  return fields;
}

class KeywordLines {
 public:
  KeywordLines(const MeshFile& file, std::string_view comment) : file_(file), comment_(comment) {}

  /// Goes to the next line that is neither empty nor a comment; false at the end.
  bool next() {
    while (end_ < file_.text.size()) {
      offset = end_;
      const size_t stop = std::min(file_.text.find('\n', offset), file_.text.size());
      end_ = stop + 1;
      line = std::string_view(file_.text).substr(offset, stop - offset);
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
      if (!trimmed(line).empty() && !line.starts_with(comment_)) return true;
    }
    line = {};
    return false;
  }
  /// The next line, if it holds data: keywords begin with *.
  bool next_data() {
    const size_t here = end_;
    if (!next()) return false;
    if (line[0] != '*') return true;
    end_ = here;
    return false;
  }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(file_.at(offset) + ": " + message); }
  template <class T>
  T number(std::string_view field, const char* what) const {
    if (field.starts_with('+')) field.remove_prefix(1);
    T value{};
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || field.empty())
      fail(fmt::format("expected {}, found '{}'", what, field.substr(0, 40)));
    return value;
  }
  std::string_view line;
  size_t offset = 0;  ///< of the line in the text

 private:
  const MeshFile& file_;
  std::string_view comment_;
  size_t end_ = 0;
};

/// Groups of a MeshFile by name, numbered as they come.
class NamedGroups {
 public:
  explicit NamedGroups(MeshFile& file) : file_(file) {}
  int number(int dimension, const std::string& name) {
    const auto [it, is_new] = known_.try_emplace({dimension, name}, int(known_.size()) + 1);
    if (is_new) file_.names[{dimension, it->second}] = name;
    return it->second;
  }

 private:
  MeshFile& file_;
  std::map<std::pair<int, std::string>, int> known_;
};

}  // namespace bw::csd
