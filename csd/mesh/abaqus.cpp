// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/abaqus.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "common/app/log.h"
#include "csd/mesh/include.h"
#include "csd/mesh/keyword_lines.h"

namespace bw::csd {
namespace {

using namespace element_type;

/// Sides S1 .. S6 of C3D8 and S1 .. S4 of C3D4 (Abaqus Analysis User's Guide, Three-dimensional solid element library).
constexpr int hex_sides[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
constexpr int tet_sides[4][3] = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};

class Reader {
 public:
  explicit Reader(MeshFile& file) : file_(file), groups_(file), in_(file, "**") {}
  void read() {
    while (in_.next()) {
      if (in_.line[0] != '*') continue;  // data of a keyword that is passed over
      read_keyword();
      const std::string key = word_;
      if (key == "NODE")
        read_nodes();
      else if (key == "ELEMENT")
        read_elements();
      else if (key == "NSET")
        read_set(node_sets_, "NSET");
      else if (key == "ELSET")
        read_set(element_sets_, "ELSET");
      else if (key == "SURFACE")
        read_surface();
      else if (key == "PART" && ++parts_ > 1)
        in_.fail("a second *PART: only files with one part are supported");
      else if (key == "INSTANCE")
        read_instance();
      else if (key == "SYSTEM")
        in_.fail("*SYSTEM is not supported: coordinates have to be global");
    }
    if (file_.x.empty()) throw InputError(file_.path + ":1: the file has no *NODE");
    add_groups();
  }

 private:
  using Sets = std::map<std::string, std::vector<int64_t>>;  // by upper-case name

  void read_keyword() {
    options_.clear();
    const auto fields = split_at_commas(in_.line.substr(1));
    word_ = upper(fields[0]);
    for (size_t i = 1; i < fields.size(); ++i) {
      const size_t equals = fields[i].find('=');
      std::string_view value = equals == std::string_view::npos ? "" : trimmed(fields[i].substr(equals + 1));
      if (value.size() > 1 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
      options_[upper(trimmed(fields[i].substr(0, equals)))] = value;
    }
  }
  /// Name of the set that an option gives; remembers how it was written first.
  std::string set_name(const std::string& option) {
    const auto it = options_.find(option);
    if (it == options_.end()) return "";
    return remember(it->second);
  }
  std::string remember(std::string_view name) {
    const std::string key = upper(name);
    written_.try_emplace(key, name);
    return key;
  }
  void read_nodes() {
    const std::string set = set_name("NSET");
    while (in_.next_data()) {
      const auto fields = split_at_commas(in_.line);
      if (fields.size() < 4) in_.fail("expected a node number and three coordinates");
      file_.node_tag.push_back(in_.number<int64_t>(fields[0], "a node number"));
      Vec3 x;
      for (int d = 0; d < 3; ++d) x[d] = in_.number<double>(fields[size_t(d) + 1], "a coordinate");
      file_.x.push_back(x);
      if (!set.empty()) node_sets_[set].push_back(file_.node_tag.back());
    }
  }
  void read_elements() {
    const std::string set = set_name("ELSET"), type = upper(options_["TYPE"]);
    const bool is_hex = type.starts_with("C3D8"), is_tet = type.starts_with("C3D4");
    if (type.empty()) in_.fail("*ELEMENT without TYPE");
    if (!is_hex && !is_tet) {
      if (type.starts_with("C3D"))
        in_.fail(fmt::format("elements of type {}: only C3D8 and C3D4 (and their variants) are supported", type));
      warn("{}: elements of type {} are left out", file_.at(in_.offset), type);
      while (in_.next_data()) {
      }
      return;
    }
    while (in_.next_data()) {
      FileElement e{0, is_hex ? hexahedron : tetrahedron, {}, {}, in_.offset};
      std::vector<int64_t> numbers;
      const size_t wanted = 1 + size_t(element_node_count(e.type));
      while (true) {
        for (const auto field : split_at_commas(in_.line))
          if (!field.empty()) numbers.push_back(in_.number<int64_t>(field, "a node number"));
        if (numbers.size() >= wanted || !in_.next_data()) break;
      }
      if (numbers.size() != wanted)
        in_.fail(fmt::format("expected an element number and {} nodes, found {} numbers", wanted - 1, numbers.size()));
      e.tag = numbers[0];
      std::copy(numbers.begin() + 1, numbers.end(), e.nodes.begin());
      if (!index_.try_emplace(e.tag, file_.elements.size()).second)
        in_.fail(fmt::format("element {} is given twice", e.tag));
      if (!set.empty()) element_sets_[set].push_back(e.tag);
      file_.elements.push_back(e);
    }
  }
  void read_set(Sets& sets, const char* option) {
    const std::string name = set_name(option);
    if (name.empty()) in_.fail(fmt::format("*{0} without {0}=name", option));
    auto& set = sets[name];
    const bool generates = options_.contains("GENERATE");
    while (in_.next_data()) {
      const auto fields = split_at_commas(in_.line);
      if (generates) {
        if (fields.size() < 2) in_.fail("expected first, last and step");
        const auto first = in_.number<int64_t>(fields[0], "a number"),
                   last = in_.number<int64_t>(fields[1], "a number");
        const auto step = fields.size() > 2 && !fields[2].empty() ? in_.number<int64_t>(fields[2], "a step") : 1;
        if (step <= 0) in_.fail("expected a step > 0");
        for (int64_t i = first; i <= last; i += step) set.push_back(i);
        continue;
      }
      for (const auto field : fields) {
        if (field.empty()) continue;
        if (std::isdigit(static_cast<unsigned char>(field[0]))) {
          set.push_back(in_.number<int64_t>(field, "a number"));
        } else {
          const auto it = sets.find(upper(field));
          if (it == sets.end()) in_.fail(fmt::format("the set '{}' has not been given before", field));
          const std::vector<int64_t> other = it->second;
          set.insert(set.end(), other.begin(), other.end());
        }
      }
    }
  }
  void read_surface() {
    const std::string name = set_name("NAME"), type = upper(options_["TYPE"]);
    if (name.empty()) in_.fail("*SURFACE without NAME");
    while (in_.next_data()) {
      if (!type.empty() && type != "ELEMENT") continue;  // surfaces of nodes have no faces
      const auto fields = split_at_commas(in_.line);
      const std::string side = fields.size() > 1 ? upper(fields[1]) : "";
      if (side.size() != 2 || side[0] != 'S' || side[1] < '1' || side[1] > '6') {
        if (side.empty()) in_.fail("a surface of whole elements: name the sides, S1 .. S6");
        in_.fail(fmt::format("expected a side S1 .. S6, found '{}'", side));
      }
      surfaces_.push_back({name, std::string(fields[0]), side[1] - '1', in_.offset});
    }
  }
  void read_instance() {
    if (++instances_ > 1) in_.fail("a second *INSTANCE: only files with one part are supported");
    if (in_.next_data()) in_.fail("an *INSTANCE that is moved or turned is not supported: use scale, turn and move");
  }

  void add_groups() {
    for (const auto& [name, tags] : element_sets_)
      for (const int64_t tag : tags)
        if (const auto it = index_.find(tag); it != index_.end()) {
          auto& physical = file_.elements[it->second].physical;
          const int number = groups_.number(3, written_[name]);
          if (std::find(physical.begin(), physical.end(), number) == physical.end()) physical.push_back(number);
        }
    const size_t volumes = file_.elements.size();
    for (const auto& surface : surfaces_)
      for (const int64_t tag : elements_of(surface))
        if (const auto it = index_.find(tag); it != index_.end() && it->second < volumes) add_side(surface, it->second);
    const std::unordered_map<int64_t, int> known = [&] {
      std::unordered_map<int64_t, int> tags;
      for (const int64_t tag : file_.node_tag) tags[tag] = 1;
      return tags;
    }();
    for (const auto& [name, tags] : node_sets_)
      for (const int64_t tag : tags) {
        if (!known.contains(tag))
          throw InputError(fmt::format("{}: the node set '{}' holds node {}, which is not in the file", file_.path,
                                       written_[name], tag));
        file_.elements.push_back({0, point, {groups_.number(0, written_[name])}, {tag}, 0});
      }
  }
  struct Surface {
    std::string name, elements;
    int side;
    size_t offset;
  };
  std::vector<int64_t> elements_of(const Surface& s) const {
    if (const auto it = element_sets_.find(upper(s.elements)); it != element_sets_.end()) return it->second;
    int64_t tag = 0;
    const auto [end, error] = std::from_chars(s.elements.data(), s.elements.data() + s.elements.size(), tag);
    if (error != std::errc() || end != s.elements.data() + s.elements.size() || !index_.contains(tag))
      throw InputError(fmt::format("{}: neither an element nor an element set: '{}'", file_.at(s.offset), s.elements));
    return {tag};
  }
  void add_side(const Surface& s, size_t element) {
    const FileElement& e = file_.elements[element];
    const int number = groups_.number(2, written_[s.name]);
    FileElement face{0, e.type == hexahedron ? quadrangle : triangle, {number}, {}, s.offset};
    if (e.type == tetrahedron && s.side > 3)
      throw InputError(fmt::format("{}: side S{} of the tetrahedron {}", file_.at(s.offset), s.side + 1, e.tag));
    for (size_t a = 0; a < size_t(element_node_count(face.type)); ++a)
      face.nodes[a] = e.nodes[size_t(e.type == hexahedron ? hex_sides[s.side][a] : tet_sides[s.side][a])];
    file_.elements.push_back(face);
  }

  MeshFile& file_;
  NamedGroups groups_;
  KeywordLines in_;
  std::string word_;                                      // of the present keyword
  std::map<std::string, std::string> options_, written_;  // of the keyword; names as they were written first
  Sets node_sets_, element_sets_;
  std::vector<Surface> surfaces_;
  std::unordered_map<int64_t, size_t> index_;  // of an element number
  int parts_ = 0, instances_ = 0;
};

}  // namespace

Mesh Abaqus::make() const {
  MeshFile raw;
  read_with_includes(file, place, IncludeStyle::abaqus, raw);
  Reader(raw).read();
  return mesh_of(std::move(raw), elements, place);
}

}  // namespace bw::csd
