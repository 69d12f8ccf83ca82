// SPDX-License-Identifier: Apache-2.0
#include "common/io/document.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cctype>
#include <cstring>

#include "common/app/error.h"

namespace bw {

namespace {

using Kind = DocumentNode::Kind;

/// Every dot of a dotted name is a level of tables that later code walks by recursion: no case needs more than a few.
void refuse_endless_names(const std::string& text, const std::string& name) {
  constexpr int limit = 500;
  int line = 1, dots = 0;
  for (const char c : text) {
    if (c == '\n') ++line;
    if (c == '.')
      ++dots;
    else if (!std::isalnum(static_cast<unsigned char>(c)) && !std::strchr("_-\"' \t", c))
      dots = 0;
    if (dots > limit) throw InputError(fmt::format("{}:{}: a word of more than {} dots", name, line, limit));
  }
}

DocumentNode convert(const toml::node& node) {
  DocumentNode out;
  out.line = int(node.source().begin.line);
  if (const auto* table = node.as_table()) {
    out.kind = Kind::table;
    for (const auto& [key, value] : *table) {
      DocumentEntry entry{std::string(key.str()), convert(value)};
      if (key.source().begin.line) entry.value.line = int(key.source().begin.line);
      out.entries.push_back(std::move(entry));
    }
    std::stable_sort(out.entries.begin(), out.entries.end(),
                     [](const DocumentEntry& a, const DocumentEntry& b) { return a.value.line < b.value.line; });
  } else if (const auto* list = node.as_array()) {
    out.kind = Kind::list;
    for (const auto& item : *list) out.items.push_back(convert(item));
  } else if (const auto* text = node.as_string()) {
    out.kind = Kind::text;
    out.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    out.kind = Kind::integer;
    out.integer = integer->get();
    out.number = double(out.integer);
  } else if (const auto* number = node.as_floating_point()) {
    out.kind = Kind::number;
    out.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    out.kind = Kind::boolean;
    out.boolean = boolean->get();
  } else {
    out.kind = Kind::date;
  }
  return out;
}

}  // namespace

const DocumentNode* DocumentNode::find(const std::string& key) const {
  for (const auto& entry : entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

std::string DocumentNode::shown() const {
  switch (kind) {
    case Kind::table:
      return "a table";
    case Kind::list: {
      const auto plain = [](const DocumentNode& i) { return i.kind != Kind::table && i.kind != Kind::list; };
      if (items.empty() || items.size() > 6 || !std::all_of(items.begin(), items.end(), plain))
        return fmt::format("a list of {}", items.size());
      std::string all;
      for (const DocumentNode& i : items) all += (all.empty() ? "[" : ", ") + i.shown();
      return all + "]";
    }
    case Kind::text:
      return text.size() <= 60 ? fmt::format("\"{}\"", text) : fmt::format("\"{}...\"", text.substr(0, 60));
    case Kind::integer:
      return fmt::format("{}", integer);
    case Kind::number:
      return fmt::format("{}", number);
    case Kind::boolean:
      return boolean ? "true" : "false";
    case Kind::date:
      break;
  }
  return "a date or time";
}

DocumentNode parse_document(const std::string& text, const std::string& name) {
  refuse_endless_names(text, name);
  try {
    DocumentNode root = convert(toml::parse(text, name));
    root.line = 0;
    return root;
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}: not valid TOML: {}", name, e.source().begin.line, e.description()));
  }
}

}  // namespace bw
