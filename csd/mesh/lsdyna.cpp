// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/lsdyna.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "common/app/log.h"
#include "csd/mesh/include.h"
#include "csd/mesh/keyword_lines.h"

namespace bw::csd {
namespace {

using namespace element_type;

/// Widths of the fields of a card.
using Widths = std::vector<size_t>;
const Widths node_card{8, 16, 16, 16, 8, 8}, element_card(10, 8), set_card(8, 10);

class Reader {
 public:
  explicit Reader(MeshFile& file) : file_(file), groups_(file), in_(file, "$") {}
  void read() {
    while (in_.next()) {
      if (in_.line[0] != '*') continue;  // data of a keyword that is passed over
      const std::string key = upper(trimmed(in_.line.substr(1)));
      if (key == "END") break;
      read(key);
    }
    if (file_.x.empty()) throw InputError(file_.path + ":1: the file has no *NODE");
    add_groups();
  }

 private:
  void read(const std::string& key) {
    const bool has_title = key.ends_with("_TITLE");
    const std::string word = has_title ? key.substr(0, key.size() - 6) : key;
    if (word.find("LONG=") != std::string::npos || word.ends_with('+') || word.ends_with('%'))
      in_.fail("the long or short format of fields is not supported");
    if (word == "NODE")
      read_nodes();
    else if (word == "ELEMENT_SOLID" || word.starts_with("ELEMENT_SOLID "))
      read_elements();
    else if (word.starts_with("ELEMENT_"))
      warn("{}: *{} is left out", file_.at(in_.offset), word);
    else if (word == "PART")
      read_parts();
    else if (word == "SET_NODE" || word == "SET_NODE_LIST")
      read_set(0, has_title);
    else if (word == "SET_SOLID")
      read_set(3, has_title);
    else if (word == "SET_NODE_LIST_GENERATE")
      read_generated_nodes(has_title);
    else if (word == "SET_SEGMENT")
      read_segments(has_title);
    else if (word.starts_with("INCLUDE"))
      in_.fail(fmt::format("*{} is not supported: only *INCLUDE", word));
  }

  /// The non-empty leading fields of the present line.
  std::vector<std::string_view> fields(const Widths& widths) const {
    std::vector<std::string_view> found;
    if (in_.line.find(',') != std::string_view::npos) {
      found = split_at_commas(in_.line);
    } else {
      size_t at = 0;
      for (const size_t width : widths) {
        if (at >= in_.line.size()) break;
        found.push_back(trimmed(in_.line.substr(at, width)));
        at += width;
      }
    }
    while (!found.empty() && found.back().empty()) found.pop_back();
    return found;
  }
  void read_nodes() {
    while (in_.next_data()) {
      const auto f = fields(node_card);
      if (f.empty()) in_.fail("expected a node number and three coordinates");
      file_.node_tag.push_back(in_.number<int64_t>(f[0], "a node number"));
      Vec3 x;  // an empty field is 0
      for (size_t d = 0; d < 3; ++d)
        if (d + 1 < f.size() && !f[d + 1].empty()) x[int(d)] = in_.number<double>(f[d + 1], "a coordinate");
      file_.x.push_back(x);
    }
  }
  void read_elements() {
    while (in_.next_data()) {
      auto f = fields(element_card);
      if (f.size() < 2) in_.fail("expected an element number, a part and eight nodes");
      const auto tag = in_.number<int64_t>(f[0], "an element number");
      const auto part = in_.number<int64_t>(f[1], "a part number");
      const size_t offset = in_.offset;
      if (f.size() == 2) {  // nodes on a line of their own
        if (!in_.next_data()) in_.fail(fmt::format("element {} has no nodes", tag));
        f = fields(element_card);
      } else {
        f.erase(f.begin(), f.begin() + 2);
      }
      std::vector<int64_t> n;
      for (const auto field : f)
        if (n.push_back(in_.number<int64_t>(field, "a node number")); n.back() == 0) n.pop_back();
      if (n.size() > 8) in_.fail(fmt::format("element {} has {} nodes: only 8 are supported", tag, n.size()));
      if (n.size() < 4) in_.fail(fmt::format("expected eight nodes of element {}, found {}", tag, n.size()));
      add_element(tag, part, n, offset);
    }
  }
  void add_element(int64_t tag, int64_t part, std::vector<int64_t> n, size_t offset) {
    n.resize(8, n.back());
    const bool is_tet = std::all_of(n.begin() + 4, n.end(), [&](int64_t i) { return i == n[3]; });
    FileElement e{tag, is_tet ? tetrahedron : hexahedron, {}, {}, offset};
    std::copy_n(n.begin(), is_tet ? 4 : 8, e.nodes.begin());
    if (!is_tet) {
      auto sorted = n;
      std::sort(sorted.begin(), sorted.end());
      if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        in_.fail(fmt::format("element {} uses a node twice: only hexahedra and tetrahedra are supported", tag));
    }
    if (!index_.try_emplace(tag, file_.elements.size()).second) in_.fail(fmt::format("element {} is given twice", tag));
    part_.push_back(part);
    file_.elements.push_back(e);
  }
  void read_parts() {
    while (in_.next_data()) {
      const std::string title(trimmed(in_.line));
      if (!in_.next_data()) in_.fail("expected a part number after the title of a part");
      const auto f = fields(set_card);
      title_[in_.number<int64_t>(f.empty() ? "" : f[0], "a part number")] = title;
    }
  }
  /// Reads title and number of a set; its name.
  std::string set_name(bool has_title) {
    std::string title;
    if (has_title && in_.next_data()) title = trimmed(in_.line);
    if (!in_.next_data()) in_.fail("expected the number of a set");
    const auto f = fields(set_card);
    const auto number = in_.number<int64_t>(f.empty() ? "" : f[0], "the number of a set");
    return title.empty() ? std::to_string(number) : title;
  }
  template <class Use>
  void for_numbers(const Use& use) {
    while (in_.next_data())
      for (const auto field : fields(set_card))
        if (const auto tag = in_.number<int64_t>(field, "a number"); tag != 0) use(tag);
  }
  void read_set(int dimension, bool has_title) {
    const std::string name = set_name(has_title);
    for_numbers([&](int64_t tag) { sets_.push_back({name, dimension, tag, in_.offset}); });
  }
  void read_generated_nodes(bool has_title) {
    const std::string name = set_name(has_title);
    std::vector<int64_t> ends;
    for_numbers([&](int64_t tag) { ends.push_back(tag); });
    for (size_t i = 0; i + 1 < ends.size(); i += 2)
      for (const int64_t tag : file_.node_tag)  // numbers that do not exist are allowed here
        if (tag >= ends[i] && tag <= ends[i + 1]) sets_.push_back({name, 0, tag, in_.offset});
  }
  void read_segments(bool has_title) {
    const int number = groups_.number(2, set_name(has_title));
    while (in_.next_data()) {
      const auto f = fields(set_card);
      if (f.size() < 4) in_.fail("expected the four nodes of a segment");
      FileElement e{0, quadrangle, {number}, {}, in_.offset};
      for (size_t a = 0; a < 4; ++a) e.nodes[a] = in_.number<int64_t>(f[a], "a node number");
      if (e.nodes[3] == e.nodes[2] || e.nodes[3] == 0) e.type = triangle;
      segments_.push_back(e);
    }
  }

  void add_groups() {
    for (size_t i = 0; i < part_.size(); ++i) {
      const std::string& title = title_[part_[i]];
      file_.elements[i].physical.push_back(groups_.number(3, title.empty() ? std::to_string(part_[i]) : title));
    }
    std::unordered_map<int64_t, int> known;
    for (const int64_t tag : file_.node_tag) known[tag] = 1;
    for (const Member& m : sets_) {
      const auto element = index_.find(m.tag);
      if (m.dimension == 3 ? element == index_.end() : !known.contains(m.tag))
        throw InputError(fmt::format("{}: set '{}' holds {} {}, which is not in the file", file_.at(m.offset), m.name,
                                     m.dimension == 3 ? "element" : "node", m.tag));
      const int number = groups_.number(m.dimension, m.name);
      if (m.dimension == 3) {
        auto& physical = file_.elements[element->second].physical;
        if (std::find(physical.begin(), physical.end(), number) == physical.end()) physical.push_back(number);
      } else {
        members_.push_back({0, point, {number}, {m.tag}, m.offset});
      }
    }
    file_.elements.insert(file_.elements.end(), segments_.begin(), segments_.end());
    file_.elements.insert(file_.elements.end(), members_.begin(), members_.end());
  }

  struct Member {
    std::string name;
    int dimension;
    int64_t tag;
    size_t offset;
  };
  MeshFile& file_;
  NamedGroups groups_;
  KeywordLines in_;
  std::vector<int64_t> part_;                  // of each element
  std::map<int64_t, std::string> title_;       // of a part
  std::unordered_map<int64_t, size_t> index_;  // of an element number
  std::vector<Member> sets_;
  std::vector<FileElement> segments_, members_;
};

}  // namespace

Mesh LsDyna::make() const {
  MeshFile raw;
  read_with_includes(file, place, IncludeStyle::lsdyna, raw);
  Reader(raw).read();
  return mesh_of(std::move(raw), elements, place);
}

}  // namespace bw::csd
