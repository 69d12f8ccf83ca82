// SPDX-License-Identifier: Apache-2.0
#include "coupling/commit.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <vector>

#include "common/app/error.h"
#include "common/io/file.h"

namespace bw::coupling {
namespace {

namespace fs = std::filesystem;
constexpr const char* prefix = "pair_checkpoint_";

std::string text_of(const CommitMark& m) {
  return fmt::format("breakwave pair checkpoint 1\nwindow {}\nt {:.17g}\nsolid {} {}\nfluid {} {}\n", m.window, m.t,
                     m.solid, m.solid_bytes, m.fluid, m.fluid_bytes);
}

CommitMark read(const fs::path& path) {
  std::ifstream file(path);
  std::string head, words[4];
  CommitMark m;
  std::getline(file, head);
  file >> words[0] >> m.window >> words[1] >> m.t >> words[2] >> m.solid >> m.solid_bytes >> words[3] >> m.fluid >>
      m.fluid_bytes;
  if (!file || head != "breakwave pair checkpoint 1" || words[0] != "window" || words[2] != "solid")
    throw InputError(fmt::format("{}: no checkpoint of a pair", path.string()));
  m.folder = path.has_parent_path() ? path.parent_path().string() : ".";
  return m;
}

/// By window; what can't be read is none.
std::map<int64_t, fs::path> marks_in(const std::string& folder) {
  std::map<int64_t, fs::path> marks;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt" || !entry.path().filename().string().starts_with(prefix)) continue;
    try {
      marks[read(entry.path()).window] = entry.path();
    } catch (const InputError&) {
    }
  }
  return marks;
}

int64_t size_of(const std::string& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error)
    throw InputError(
        fmt::format("checkpoint of the pair: {} is not there: both programs need one output.directory", file));
  return int64_t(size);
}

bool is_of_a_program(const std::string& name) {
  return (name.starts_with("solid_checkpoint_") || name.starts_with("fluid_checkpoint_")) && name.ends_with(".h5");
}

}  // namespace

uint64_t CommitMark::hash() const {
  uint64_t h = 14695981039346656037ull;
  for (const char c : text_of(*this)) h = (h ^ uint8_t(c)) * 1099511628211ull;
  return h;
}

void commit(CommitMark mark, int keep) {
  mark.solid_bytes = size_of(mark.solid_path()), mark.fluid_bytes = size_of(mark.fluid_path());
  write_atomically(fmt::format("{}/{}{:08d}.txt", mark.folder, prefix, mark.window), text_of(mark));
  std::error_code error;  // what can't be removed does no harm
  std::map<int64_t, fs::path> marks = marks_in(mark.folder);
  // marks of later windows are of a run that was left: it went on from before them
  for (auto at = marks.upper_bound(mark.window); at != marks.end(); at = marks.erase(at)) fs::remove(at->second, error);
  for (; int(marks.size()) > keep; marks.erase(marks.begin())) fs::remove(marks.begin()->second, error);
  std::set<std::string> named;
  for (const auto& [window, path] : marks) {
    const CommitMark m = read(path);
    named.insert(m.solid), named.insert(m.fluid);
  }
  std::vector<fs::path> others;
  for (const auto& entry : fs::directory_iterator(mark.folder))
    if (const std::string name = entry.path().filename().string(); is_of_a_program(name) && !named.contains(name))
      others.push_back(entry.path());
  for (const fs::path& path : others) fs::remove(path, error);
}

CommitMark find_commit(const std::string& file_or_folder) {
  fs::path path = file_or_folder;
  if (fs::is_directory(path)) {
    const auto marks = marks_in(file_or_folder);
    if (marks.empty())
      throw InputError(fmt::format("{}: no checkpoint of a pair ({}*.txt) in this folder", file_or_folder, prefix));
    path = marks.rbegin()->second;
  }
  if (!fs::is_regular_file(path)) throw InputError(fmt::format("{}: there is no such checkpoint", file_or_folder));
  const CommitMark m = read(path);
  for (const auto& [file, bytes] : {std::pair{m.solid_path(), m.solid_bytes}, {m.fluid_path(), m.fluid_bytes}}) {
    std::error_code error;
    if (const auto size = fs::file_size(file, error); error || int64_t(size) != bytes)
      throw InputError(fmt::format("{}: {} is not there as it was written", path.string(), file));
  }
  return m;
}

}  // namespace bw::coupling
