// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/include.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "csd/mesh/keyword_lines.h"

namespace bw::csd {
namespace {

class Expander {
 public:
  Expander(IncludeStyle style, MeshFile& out) : style_(style), out_(out) {}

  void add(const std::string& path, const std::string& place) {
    if (std::find(open_.begin(), open_.end(), path) != open_.end())
      throw InputError(fmt::format("{}: the file '{}' includes itself", place, path));
    open_.push_back(path);
    const std::string text = read_mesh_text(path, place);
    out_.pieces.push_back({out_.text.size(), path, 1});
    bool names_follow = false;
    int64_t number = 1;
    for (size_t begin = 0; begin < text.size(); ++number) {
      const size_t stop = std::min(text.find('\n', begin), text.size());
      const std::string_view whole = std::string_view(text).substr(begin, stop - begin), line = trimmed(whole);
      begin = stop + 1;
      const bool is_keyword = line.starts_with('*') && !line.starts_with("**");
      if (is_keyword) names_follow = false;
      if (is_keyword && style_ == IncludeStyle::lsdyna && upper(line) == "*END") break;
      const std::string here = fmt::format("{}:{}", path, number);
      std::string name;
      if (is_keyword && is_include(line)) {
        names_follow = style_ == IncludeStyle::lsdyna;
        name = style_ == IncludeStyle::abaqus ? name_in(line, here) : "";
      } else if (names_follow && !line.empty() && !line.starts_with('$')) {
        name = line;
      } else if (!names_follow) {
        out_.text.append(whole).push_back('\n');
        continue;
      }
      if (!name.empty()) add((std::filesystem::path(path).parent_path() / name).lexically_normal(), here);
      out_.pieces.push_back({out_.text.size(), path, number + 1});
    }
    open_.pop_back();
  }

 private:
  static bool is_include(std::string_view line) {
    return upper(trimmed(line.substr(1, line.find(',') == std::string_view::npos ? line.npos : line.find(',') - 1))) ==
           "INCLUDE";
  }
  static std::string name_in(std::string_view line, const std::string& here) {
    for (std::string_view field : split_at_commas(line)) {
      const size_t equals = field.find('=');
      if (equals == field.npos || upper(trimmed(field.substr(0, equals))) != "INPUT") continue;
      std::string_view name = trimmed(field.substr(equals + 1));
      if (name.size() > 1 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
      return std::string(name);
    }
    throw InputError(here + ": *INCLUDE without INPUT=name");
  }

  IncludeStyle style_;
  MeshFile& out_;
  std::vector<std::string> open_;  // files that are being read
};

}  // namespace

void read_with_includes(const std::string& path, const std::string& place, IncludeStyle style, MeshFile& file) {
  file.path = path;
  Expander(style, file).add(path, place);
}

}  // namespace bw::csd
