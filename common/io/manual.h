// SPDX-License-Identifier: Apache-2.0
// The manual of the case file, collected by walking every describe() once (Keys::manual()).
#pragma once
#include <memory>
#include <string>
#include <vector>

namespace bw {

struct ManualSection {
  struct Entry {
    std::string key, kind, fallback, doc;  ///< fallback: the default as text, empty: required
  };
  std::string path;  ///< "solid.body[].mesh"
  std::string note;  ///< how often it may stand, which alternative it is
  std::string doc;
  std::vector<Entry> entries;
  std::vector<std::unique_ptr<ManualSection>> sections;

  ManualSection& add(std::string new_path, std::string new_note, std::string new_doc);
  /// The whole tree as Markdown that reads well as plain text.
  std::string text() const;
};

}  // namespace bw
