// SPDX-License-Identifier: Apache-2.0
// A parsed TOML file as plain data: every value knows the line it stands on. The only home of toml++ is document.cpp.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace bw {

struct DocumentEntry;

struct DocumentNode {
  enum class Kind { table, list, text, integer, number, boolean, date };
  Kind kind = Kind::table;
  int line = 0;  ///< of its key, or of the value inside a list; 0: the file as a whole
  std::string text;
  double number = 0;
  int64_t integer = 0;
  bool boolean = false;
  std::vector<DocumentEntry> entries;  ///< of a table, in the order of the file
  std::vector<DocumentNode> items;     ///< of a list

  const DocumentNode* find(const std::string& key) const;
  /// What stands there, for messages: `the text "abc"`, `the number 3.5`, `a table` ...
  std::string shown() const;
};

struct DocumentEntry {
  std::string key;
  DocumentNode value;
};

/// Throws InputError "name:line: ..." on any text that is not TOML.
DocumentNode parse_document(const std::string& text, const std::string& name);

}  // namespace bw
