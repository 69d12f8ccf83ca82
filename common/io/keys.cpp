// SPDX-License-Identifier: Apache-2.0
#include "common/io/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>

#include "common/io/document.h"
#include "common/io/manual.h"

namespace bw {

using Kind = DocumentNode::Kind;

/// One table of the file (absent: no node), or one section of the manual.
struct Keys::Impl {
  std::string file, folder;
  std::shared_ptr<const DocumentNode> root;
  const DocumentNode* table = nullptr;
  int line = 0;      ///< of the table, or of the nearest one around it that the file has
  std::string path;  ///< "solid.body[0]"
  std::set<std::string> known;
  std::string picked;  ///< `kind = "box"` that chose the keys of this table

  std::shared_ptr<ManualSection> manual;
  ManualSection* section = nullptr;
  std::vector<ManualSection*> outer;  ///< sections around the alternative being described

  const DocumentNode* find(const char* key) {
    known.insert(key);
    return table ? table->find(key) : nullptr;
  }
  std::string path_of(const std::string& key) const { return path.empty() ? key : path + "." + key; }
  std::string place(int at) const { return at > 0 ? fmt::format("{}:{}", file, at) : file; }
  [[noreturn]] void wrong(const DocumentNode& node, const std::string& key, const std::string& message) const {
    throw InputError(fmt::format("{}: {}: {}", place(node.line), path_of(key), message));
  }
  [[noreturn]] void missing(const char* key, const std::string& expected, const char* doc) const;
  void add_entry(const char* key, const std::string& kind, const std::string& fallback, const char* doc) {
    section->entries.push_back({key, kind, fallback, doc});
  }
};

namespace {

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = int(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = int(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int change = diagonal + (std::tolower(a[i - 1]) != std::tolower(b[j - 1]));
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row[b.size()];
}

/// The nearest of the names if it is near enough to be meant: a third of its letters wrong, or one contains the other.
template <class Names>
std::string nearest(const std::string& word, const Names& names) {
  std::string best;
  int best_distance = std::numeric_limits<int>::max();
  if (word.empty() || word.size() > 60) return best;
  for (const std::string& name : names) {
    const bool part = std::min(name.size(), word.size()) >= 4 &&
                      (name.find(word) != std::string::npos || word.find(name) != std::string::npos);
    const int d = part ? 1 : edit_distance(word, name);
    if (d < best_distance && (part || 3 * d <= int(std::max(word.size(), name.size())) + 1)) {
      best = name;
      best_distance = d;
    }
  }
  return best;
}

template <class Names>
std::string listed(const Names& names, const char* quote = "\"") {
  std::string out;
  for (const std::string& n : names) out += fmt::format("{}{}{}{}", out.empty() ? "" : ", ", quote, n, quote);
  return out;
}

/// The shorter of "1000000000" and "1e+09" that has all digits.
std::string shown(double value) {
  const std::string all = fmt::format("{}", value), few = fmt::format("{:.6g}", value);
  return std::stod(few) == value && few.size() < all.size() ? few : all;
}
/// A default as it could be typed.
std::string shown(double value, Dim dim) {
  if (std::isinf(value)) return value > 0 ? "unlimited" : "-unlimited";
  if (std::isnan(value)) return "none";
  return dim == dim::none || value == 0 ? shown(value) : fmt::format("\"{} {}\"", shown(value), si_symbol(dim));
}
std::string shown(const Vec3& v) { return fmt::format("[{}, {}, {}]", shown(v.x), shown(v.y), shown(v.z)); }

std::string kind_with_unit(const char* what, Dim dim) {
  return dim == dim::none ? what : fmt::format("{} [{}]", what, si_symbol(dim));
}

double read_number(const Keys::Impl& impl, const DocumentNode& node, const std::string& key, Dim dim) {
  if (node.kind == Kind::text) {
    try {
      return parse_quantity(node.text, dim);
    } catch (const InputError& e) {
      impl.wrong(node, key, e.what());
    }
  }
  const bool is_number = node.kind == Kind::integer || (node.kind == Kind::number && std::isfinite(node.number));
  if (!is_number) impl.wrong(node, key, fmt::format("expected {}, got {}", dimension_name(dim), node.shown()));
  return node.number;
}

int read_integer(const Keys::Impl& impl, const DocumentNode& node, const std::string& key) {
  if (node.kind != Kind::integer) impl.wrong(node, key, fmt::format("expected a whole number, got {}", node.shown()));
  if (node.integer != int(node.integer))
    impl.wrong(node, key, fmt::format("expected a whole number below 2^31 in size, got {}", node.integer));
  return int(node.integer);
}

std::string read_word(const Keys::Impl& impl, const DocumentNode& node, const std::string& key) {
  if (node.kind != Kind::text) impl.wrong(node, key, fmt::format("expected a text, got {}", node.shown()));
  return node.text;
}

const std::vector<DocumentNode>& read_list(const Keys::Impl& impl, const DocumentNode& node, const std::string& key,
                                           const std::string& of_what) {
  if (node.kind != Kind::list)
    impl.wrong(node, key, fmt::format("expected a list of {}, got {}", of_what, node.shown()));
  return node.items;
}

Vec3 read_point(const Keys::Impl& impl, const DocumentNode& node, const std::string& key, Dim dim) {
  if (node.kind != Kind::list || node.items.size() != 3)
    impl.wrong(node, key,
               fmt::format("expected a list of 3 numbers, each {}, got {}", dimension_name(dim), node.shown()));
  Vec3 p;
  for (int d = 0; d < 3; ++d) p[d] = read_number(impl, node.items[size_t(d)], fmt::format("{}[{}]", key, d), dim);
  return p;
}

/// A list whose items are read by item(node, "key[i]").
template <class T, class Item>
void read_items(const Keys::Impl& impl, const DocumentNode& node, const std::string& key, const std::string& of_what,
                std::vector<T>& value, const Item& item) {
  std::vector<T> read;
  for (const DocumentNode& n : read_list(impl, node, key, of_what))
    read.push_back(item(n, fmt::format("{}[{}]", key, read.size())));
  value = std::move(read);
}

}  // namespace

void Keys::Impl::missing(const char* key, const std::string& expected, const char* doc) const {
  std::string hint;
  if (table) {
    std::vector<std::string> unread;
    for (const auto& e : table->entries)
      if (!known.contains(e.key)) unread.push_back(e.key);
    if (const std::string near = nearest(std::string(key), unread); !near.empty())
      hint = fmt::format("; line {} has \"{}\"", table->find(near)->line, near);
  }
  throw InputError(fmt::format("{}: {}: missing; expected {}: {}{}", place(line), path_of(key), expected, doc, hint));
}

// --- making one
// ------------------------------------------------------------------------------------------------------------

Keys Keys::read_file(const std::string& path) {
  std::error_code ignored;
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path, ignored))
    throw InputError(fmt::format("{}: cannot be read as a file", path));
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  Keys keys = read_text(text, path);
  keys.impl_->folder = std::filesystem::path(path).parent_path().string();
  return keys;
}

Keys Keys::read_text(const std::string& text, const std::string& name) {
  auto impl = std::make_shared<Impl>();
  impl->file = name;
  impl->root = std::make_shared<const DocumentNode>(parse_document(text, name));
  impl->table = impl->root.get();
  return Keys(impl);
}

Keys Keys::manual() {
  auto impl = std::make_shared<Impl>();
  impl->file = "manual";
  impl->manual = std::make_shared<ManualSection>();
  impl->section = impl->manual.get();
  return Keys(impl);
}

std::string Keys::manual_text() const { return impl_->manual ? impl_->manual->text() : std::string(); }

// --- values
// ----------------------------------------------------------------------------------------------------------------

void Keys::number(const char* key, double& value, Dim dim, const char* doc, bool is_required) {
  if (is_manual())
    return impl_->add_entry(key, kind_with_unit("number", dim), is_required ? "" : shown(value, dim), doc);
  if (const auto* node = impl_->find(key))
    value = read_number(*impl_, *node, key, dim);
  else if (is_required)
    impl_->missing(key, dimension_name(dim), doc);
}

void Keys::point(const char* key, Vec3& value, Dim dim, const char* doc, bool is_required) {
  if (is_manual())
    return impl_->add_entry(key, kind_with_unit("list of 3 numbers", dim), is_required ? "" : shown(value), doc);
  if (const auto* node = impl_->find(key))
    value = read_point(*impl_, *node, key, dim);
  else if (is_required)
    impl_->missing(key, fmt::format("a list of 3 numbers, each {}", dimension_name(dim)), doc);
}

void Keys::numbers(const char* key, std::vector<double>& value, Dim dim, const char* doc, bool is_required) {
  if (is_manual()) {
    const std::string fallback = fmt::format("[{}]", fmt::join(value, ", "));
    return impl_->add_entry(key, kind_with_unit("list of numbers", dim), is_required ? "" : fallback, doc);
  }
  const std::string of_what = fmt::format("numbers, each {}", dimension_name(dim));
  if (const auto* node = impl_->find(key))
    read_items(*impl_, *node, key, of_what, value,
               [&](const DocumentNode& n, const std::string& k) { return read_number(*impl_, n, k, dim); });
  else if (is_required)
    impl_->missing(key, "a list of " + of_what, doc);
}

void Keys::points(const char* key, std::vector<Vec3>& value, Dim dim, const char* doc, bool is_required) {
  if (is_manual()) {
    std::string fallback;
    for (const Vec3& p : value) fallback += (fallback.empty() ? "" : ", ") + shown(p);
    return impl_->add_entry(key, kind_with_unit("list of lists of 3 numbers", dim),
                            is_required ? "" : fmt::format("[{}]", fallback), doc);
  }
  const std::string of_what = fmt::format("points [a, b, c], each number {}", dimension_name(dim));
  if (const auto* node = impl_->find(key))
    read_items(*impl_, *node, key, of_what, value,
               [&](const DocumentNode& n, const std::string& k) { return read_point(*impl_, n, k, dim); });
  else if (is_required)
    impl_->missing(key, "a list of " + of_what, doc);
}

void Keys::integer(const char* key, int& value, const char* doc, bool is_required) {
  if (is_manual()) return impl_->add_entry(key, "whole number", is_required ? "" : fmt::format("{}", value), doc);
  if (const auto* node = impl_->find(key))
    value = read_integer(*impl_, *node, key);
  else if (is_required)
    impl_->missing(key, "a whole number", doc);
}

void Keys::integers(const char* key, std::vector<int>& value, const char* doc, bool is_required) {
  if (is_manual()) {
    const std::string fallback = fmt::format("[{}]", fmt::join(value, ", "));
    return impl_->add_entry(key, "list of whole numbers", is_required ? "" : fallback, doc);
  }
  if (const auto* node = impl_->find(key))
    read_items(*impl_, *node, key, "whole numbers", value,
               [&](const DocumentNode& n, const std::string& k) { return read_integer(*impl_, n, k); });
  else if (is_required)
    impl_->missing(key, "a list of whole numbers", doc);
}

void Keys::boolean(const char* key, bool& value, const char* doc, bool is_required) {
  if (is_manual()) return impl_->add_entry(key, "true or false", is_required ? "" : value ? "true" : "false", doc);
  if (const auto* node = impl_->find(key)) {
    if (node->kind != Kind::boolean)
      impl_->wrong(*node, key, fmt::format("expected true or false, got {}", node->shown()));
    value = node->boolean;
  } else if (is_required) {
    impl_->missing(key, "true or false", doc);
  }
}

void Keys::text(const char* key, std::string& value, const char* doc, bool is_required) {
  if (is_manual()) return impl_->add_entry(key, "text", is_required ? "" : fmt::format("\"{}\"", value), doc);
  if (const auto* node = impl_->find(key))
    value = read_word(*impl_, *node, key);
  else if (is_required)
    impl_->missing(key, "a text", doc);
}

void Keys::texts(const char* key, std::vector<std::string>& value, const char* doc, bool is_required) {
  if (is_manual())
    return impl_->add_entry(key, "list of texts", is_required ? "" : fmt::format("[{}]", listed(value)), doc);
  if (const auto* node = impl_->find(key))
    read_items(*impl_, *node, key, "texts", value,
               [&](const DocumentNode& n, const std::string& k) { return read_word(*impl_, n, k); });
  else if (is_required)
    impl_->missing(key, "a list of texts", doc);
}

void Keys::choice(const char* key, std::string& value, const std::vector<std::string>& words, const char* doc) {
  if (is_manual())
    return impl_->add_entry(key, "one of " + listed(words), value.empty() ? "" : fmt::format("\"{}\"", value), doc);
  const auto at = std::find(words.begin(), words.end(), value);
  const int fallback = at == words.end() ? 0 : int(at - words.begin());
  const std::string alternative = impl_->picked;  // a choice brings no keys of its own
  const int chosen = picked(key, words, fallback, doc, value.empty());
  impl_->picked = alternative;
  if (has(key)) value = words[size_t(chosen)];
}

// --- tables
// ----------------------------------------------------------------------------------------------------------------

bool Keys::walks(const char* key) const {
  if (is_manual()) return true;
  return impl_->find(key) != nullptr;
}

Keys Keys::open(const char* key, const char* doc, bool is_required) {
  auto sub = std::make_shared<Impl>(*impl_);
  sub->known.clear();
  sub->picked.clear();
  sub->outer.clear();
  sub->path = impl_->path_of(key);
  if (is_manual()) {
    sub->path = impl_->section->path.empty() ? key : impl_->section->path + "." + key;
    sub->section = &impl_->section->add(sub->path, is_required ? "table" : "table, may be absent", doc);
    return Keys(sub);
  }
  sub->table = impl_->find(key);
  if (sub->table) {
    if (sub->table->kind != Kind::table)
      impl_->wrong(*sub->table, key, fmt::format("expected a table, got {}: {}", sub->table->shown(), doc));
    sub->line = sub->table->line;
  }
  return Keys(sub);
}

int Keys::count(const char* key) const {
  if (is_manual()) return 1;
  const DocumentNode* node = impl_->find(key);
  if (!node) return 0;
  if (node->kind != Kind::list)
    impl_->wrong(*node, key,
                 fmt::format("expected a list of tables ([[{}]]), got {}", impl_->path_of(key), node->shown()));
  return int(node->items.size());
}

Keys Keys::open_item(const char* key, int i, const char* doc) {
  auto sub = std::make_shared<Impl>(*impl_);
  sub->known.clear();
  sub->picked.clear();
  sub->outer.clear();
  if (is_manual()) {
    sub->path = (impl_->section->path.empty() ? key : impl_->section->path + "." + key) + std::string("[]");
    sub->section = &impl_->section->add(sub->path, "any number of tables", doc);
    return Keys(sub);
  }
  sub->path = fmt::format("{}[{}]", impl_->path_of(key), i);
  const DocumentNode& item = impl_->find(key)->items[size_t(i)];
  if (item.kind != Kind::table)
    impl_->wrong(item, fmt::format("{}[{}]", key, i), fmt::format("expected a table, got {}", item.shown()));
  sub->table = &item;
  sub->line = item.line;
  return Keys(sub);
}

void Keys::close(Keys& sub) {
  const Impl& s = *sub.impl_;
  if (is_manual() || !s.table) return;
  for (const auto& entry : s.table->entries) {
    if (s.known.contains(entry.key)) continue;
    const std::string near = nearest(entry.key, s.known);
    const std::string with = s.picked.empty() ? "" : fmt::format(" for {}", s.picked);
    const std::string what = entry.value.kind == Kind::table ? "table" : "key";
    const std::string hint = !near.empty()     ? fmt::format("did you mean \"{}\"?", near)
                             : s.known.empty() ? "nothing is expected here"
                                               : fmt::format("expected one of {}", listed(s.known, ""));
    s.wrong(entry.value, entry.key, fmt::format("unknown {}{}; {}", what, with, hint));
  }
}

void Keys::finish(const std::vector<std::string>& others) {
  impl_->known.insert(others.begin(), others.end());
  close(*this);
}

int Keys::picked(const char* key, const std::vector<std::string>& names, int fallback, const char* doc,
                 bool is_required) {
  const DocumentNode* node = impl_->find(key);
  if (!node) {
    if (is_required) impl_->missing(key, "one of " + listed(names), doc);
    impl_->picked = fmt::format("{} = \"{}\" (the default)", key, names[size_t(fallback)]);
    return fallback;
  }
  const std::string word = node->kind == Kind::text ? node->text : "";
  const auto at = std::find(names.begin(), names.end(), word);
  if (at == names.end()) {
    const std::string near = nearest(word, names);
    impl_->wrong(*node, key,
                 fmt::format("expected one of {}, got {}{}", listed(names), node->shown(),
                             near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
  }
  impl_->picked = fmt::format("{} = \"{}\"", key, word);
  return int(at - names.begin());
}

void Keys::begin_pick(const char* key, const std::vector<std::string>& names, int fallback, const char* doc,
                      bool is_required) {
  const std::string by_default = is_required ? "" : fmt::format("\"{}\"", names[size_t(fallback)]);
  impl_->add_entry(key, "one of " + listed(names), by_default, doc);
}

void Keys::begin_alternative(const char* key, const char* name) {
  impl_->outer.push_back(impl_->section);
  impl_->section = &impl_->section->add(fmt::format("{}({} = \"{}\")", impl_->section->path, key, name), "", "");
}

void Keys::end_alternative() {
  impl_->section = impl_->outer.back();
  impl_->outer.pop_back();
}

// --- places
// ----------------------------------------------------------------------------------------------------------------

void Keys::expect(bool condition, const char* key, const std::string& what_was_expected) {
  if (condition || is_manual()) return;
  const DocumentNode* node = impl_->find(key);
  fail(key, fmt::format("expected {}{}", what_was_expected, node ? ", got " + node->shown() : std::string()));
}

void Keys::fail(const char* key, const std::string& message) const {
  throw InputError(fmt::format("{}: {}", where(key), message));
}

bool Keys::has(const char* key) const { return is_manual() || (impl_->table && impl_->table->find(key)); }

bool Keys::is_manual() const { return impl_->manual != nullptr; }

std::string Keys::where(const char* key) const {
  const DocumentNode* node = impl_->table ? impl_->table->find(key) : nullptr;
  return fmt::format("{}: {}", impl_->place(node ? node->line : impl_->line), impl_->path_of(key));
}

std::string Keys::resolve_path(const std::string& path) const {
  return (std::filesystem::path(impl_->folder) / path).lexically_normal().string();
}

}  // namespace bw
