// SPDX-License-Identifier: Apache-2.0
#include "common/io/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "common/app/error.h"
#include "common/io/document.h"
#include "common/io/file.h"

namespace bw {

namespace {

constexpr const char* kind = "breakwave checkpoint";

/// One text for all files that say the same.
std::string canonical(const DocumentNode& node) {
  using Kind = DocumentNode::Kind;
  std::string text;
  switch (node.kind) {
    case Kind::table: {
      std::map<std::string, std::string> entries;
      for (const DocumentEntry& e : node.entries) entries[e.key] = canonical(e.value);
      for (const auto& [key, value] : entries) text += fmt::format("{}:{}={}{},", key.size(), key, value.size(), value);
      return "{" + text + "}";
    }
    case Kind::list:
      for (const DocumentNode& item : node.items) text += canonical(item) + ",";
      return "[" + text + "]";
    case Kind::text:
      return fmt::format("\"{}:{}", node.text.size(), node.text);
    case Kind::integer:
    case Kind::number:
      return fmt::format("{:.17g}", node.number);
    case Kind::boolean:
      return node.boolean ? "true" : "false";
    case Kind::date:
      break;
  }
  return "date";
}

/// FNV-1a, 64 bits.
uint64_t hash(const std::string& text) {
  uint64_t h = 0xcbf29ce484222325ull;
  for (const char c : text) h = (h ^ uint8_t(c)) * 0x100000001b3ull;
  return h;
}

std::string prefix(const std::string& program) { return program + "_checkpoint_"; }

/// Complete checkpoints of the program in the folder, by step.
std::map<int64_t, std::string> checkpoints_in(const std::string& folder, const std::string& program) {
  std::map<int64_t, std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string(), start = prefix(program);
    if (!name.starts_with(start) || entry.path().extension() != ".h5") continue;
    const std::string digits = name.substr(start.size(), name.size() - start.size() - 3);
    if (!digits.empty() && digits.size() < 18 &&
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; }))
      found[std::stoll(digits)] = entry.path().string();
  }
  return found;
}

h5::File open(const std::string& path, const Comm& comm) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(fmt::format("{}: there is no such checkpoint", path));
  try {
    return h5::File::open(path, comm);
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: not a checkpoint: {}", path, e.what()));
  }
}

}  // namespace

std::string case_hash(const std::string& case_file) {
  std::ifstream in(case_file, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read", case_file));
  DocumentNode root = parse_document(std::string(std::istreambuf_iterator<char>(in), {}), case_file);
  const auto drop = [](DocumentNode& table, std::initializer_list<const char*> keys) {
    std::erase_if(table.entries,
                  [&](const DocumentEntry& e) { return std::find(keys.begin(), keys.end(), e.key) != keys.end(); });
  };
  drop(root, {"title", "time", "output", "checkpoint"});
  for (DocumentEntry& e : root.entries)
    if (e.value.kind == DocumentNode::Kind::table) drop(e.value, {"threads"});
  return fmt::format("{:016x}", hash(canonical(root)));
}

Restored Restored::section(const std::string& name) const {
  if (!has(name)) throw InputError(fmt::format("{}: the checkpoint has no {}", path_, name));
  return Restored(group_.group(name), path_);
}

std::array<int64_t, 2> Restored::need(const std::string& name, int64_t columns) const {
  if (!has(name)) throw InputError(fmt::format("{}: the checkpoint has no {}", path_, name));
  const std::array<int64_t, 2> shape = group_.shape(name);
  if (columns > 0 && shape[1] != columns)
    throw InputError(fmt::format("{}: {} has records of {} bytes, not {}: written by another version", path_, name,
                                 shape[1], columns));
  return shape;
}

CheckpointWriter::CheckpointWriter(const std::string& path, const CheckpointHead& head, const Comm& comm)
    : path_(path), comm_(comm), file_(h5::File::create(path + ".tmp", comm)) {
  const h5::Group root = file_->root();
  root.attribute("kind", std::string(kind));
  root.attribute("program", head.program);
  root.attribute("case", head.case_hash);
  root.attribute("layout", head.layout);
  root.attribute("step", head.step);
  root.attribute("t", head.t);
  root.attribute("ranks", int64_t(comm.size()));
}

void CheckpointWriter::finish() {
  file_->finish();
  file_.reset();
  comm_.barrier();
  if (comm_.root()) rename_finished(path_ + ".tmp", path_);
  comm_.barrier();
}

CheckpointReader::CheckpointReader(const std::string& path, CheckpointHead& head, const Comm& comm)
    : path_(path), file_(open(path, comm)) {
  const h5::Group root = file_.root();
  std::string program, of_case;
  int64_t layout = 0;
  try {
    if (root.read_text_attribute("kind") != kind) throw std::runtime_error("of another kind");
    program = root.read_text_attribute("program");
    of_case = root.read_text_attribute("case");
    layout = root.read_attribute<int64_t>("layout").at(0);
    head.step = root.read_attribute<int64_t>("step").at(0);
    head.t = root.read_attribute<double>("t").at(0);
    head.ranks = root.read_attribute<int64_t>("ranks").at(0);
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}: not a checkpoint: {}", path, e.what()));
  }
  if (program != head.program)
    throw InputError(fmt::format("{}: a checkpoint of the {}, expected one of the {}", path, program, head.program));
  if (layout != head.layout)
    throw InputError(fmt::format("{}: written in layout {} by another version of the program; this one reads {}", path,
                                 layout, head.layout));
  if (of_case != head.case_hash)
    throw InputError(fmt::format(
        "{}: a checkpoint of another case: only title, [time], [output], [checkpoint] and threads may change "
        "(hash {}, this case has {})",
        path, of_case, head.case_hash));
}

Restored CheckpointReader::section(const std::string& name) const {
  if (!has(name)) throw InputError(fmt::format("{}: the checkpoint has no {}", path_, name));
  return Restored(file_.root().group(name), path_);
}

std::string checkpoint_path(const std::string& folder, const std::string& program, int64_t step) {
  return fmt::format("{}/{}{:08d}.h5", folder, prefix(program), step);
}

std::string find_checkpoint(const std::string& file_or_folder, const std::string& program, int64_t step) {
  if (!std::filesystem::is_directory(file_or_folder)) {
    if (!std::filesystem::is_regular_file(file_or_folder))
      throw InputError(fmt::format("{}: there is no such checkpoint", file_or_folder));
    return file_or_folder;
  }
  const auto found = checkpoints_in(file_or_folder, program);
  if (found.empty())
    throw InputError(fmt::format("{}: no checkpoint of the {} in this folder", file_or_folder, program));
  if (step < 0) return found.rbegin()->second;
  if (!found.contains(step))
    throw InputError(fmt::format("{}: no checkpoint of the {} at step {}", file_or_folder, program, step));
  return found.at(step);
}

void drop_old_checkpoints(const std::string& folder, const std::string& program, int keep) {
  const auto found = checkpoints_in(folder, program);
  int left = int(found.size());
  for (const auto& [step, path] : found)
    if (left-- > keep) {
      std::error_code error;  // one that can't be removed does no harm
      std::filesystem::remove(path, error);
    }
}

}  // namespace bw
