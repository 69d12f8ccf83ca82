// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/gmsh.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>

#include "common/app/error.h"
#include "csd/mesh/mesh_file.h"

namespace bw::csd {

namespace {

class Reader {
 public:
  explicit Reader(MeshFile& file) : file_(file), text_(file.text) {}
  void read() {
    if (section() != "MeshFormat") fail("expected $MeshFormat: not a Gmsh file");
    read_format();
    end("MeshFormat");
    bool has_nodes = false, has_elements = false;
    while (true) {
      skip_space();
      if (at_ == text_.size()) break;
      const std::string name = section();
      if (name == "PhysicalNames")
        read_names();
      else if (name == "Entities" && is_4_)
        read_entities();
      else if (name == "Nodes")
        is_4_ ? read_nodes_4() : read_nodes_2(), has_nodes = true;
      else if (name == "Elements")
        is_4_ ? read_elements_4() : read_elements_2(), has_elements = true;
      else
        skip(name);
      end(name);
    }
    if (!has_nodes) fail("the file has no $Nodes");
    if (!has_elements) fail("the file has no $Elements");
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_at(at_, message); }
  [[noreturn]] void fail_at(size_t offset, const std::string& message) const {
    throw InputError(file_.at(offset) + ": " + message);
  }

  // --- words and numbers
  // ------------------------------------------------------------------------------------------------
  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }
  std::string_view word() {
    skip_space();
    const size_t begin = at_;
    while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }
  template <class T>
  T from_text(const char* what) {
    const std::string_view w = word();
    T value{};
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || end != w.data() + w.size())
      fail_at(at_ - w.size(), fmt::format("expected {}, found {}", what,
                                          w.empty() ? "the end of the file" : fmt::format("'{}'", w.substr(0, 40))));
    return value;
  }
  template <class T>
  T from_bytes(const char* what) {
    if (text_.size() - at_ < sizeof(T)) fail(fmt::format("expected {}, found the end of the file", what));
    char bytes[sizeof(T)];
    std::memcpy(bytes, text_.data() + at_, sizeof(T));
    if (is_swapped_) std::reverse(bytes, bytes + sizeof(T));
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
  }
  template <class T>
  T get(const char* what) {
    return file_.is_binary ? from_bytes<T>(what) : from_text<T>(what);
  }
  size_t count(int64_t n, const char* what) const {  // no allocation on the word of a broken file
    if (n < 0 || uint64_t(n) > text_.size()) fail(fmt::format("{} {}: more than the file can hold", n, what));
    return size_t(n);
  }

  // --- sections
  // ---------------------------------------------------------------------------------------------------------
  std::string section() {
    skip_space();
    const size_t begin = at_;
    const std::string name(word());
    if (name.size() < 2 || name[0] != '$' || name.starts_with("$End"))
      fail_at(begin, fmt::format("expected a section like $Nodes, found '{}'", name.substr(0, 40)));
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ < text_.size()) ++at_;  // one line end; what follows may be binary
    return name.substr(1);
  }
  void end(const std::string& name) {
    skip_space();
    const size_t begin = at_;
    if (const std::string_view w = word(); w != fmt::format("$End{}", name))
      fail_at(begin, fmt::format("expected $End{}, found '{}'", name, w.substr(0, 40)));
  }
  void skip(const std::string& name) {
    const size_t found = text_.find(fmt::format("$End{}", name), at_);
    if (found == std::string::npos) fail(fmt::format("section ${} has no end", name));
    at_ = found;
  }
  void read_format() {
    const size_t begin = at_;
    const std::string version(word());
    if (version != "2.2" && version != "4.1")
      fail_at(begin, fmt::format("format {} (supported: 2.2 and 4.1; gmsh -format msh41)", version));
    is_4_ = version == "4.1";
    const int kind = from_text<int>("0 (text) or 1 (binary)"), size = from_text<int>("the size of a number");
    if (size != 8) fail(fmt::format("numbers of {} bytes (supported: 8)", size));
    if (kind == 0) return;
    file_.is_binary = true;
    line_end();
    const auto one = from_bytes<int32_t>("the number 1");
    is_swapped_ = one == 0x01000000;
    if (one != 1 && !is_swapped_) fail("expected the binary number 1 (byte order)");
  }
  void line_end() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    if (at_ < text_.size()) ++at_;
  }
  void read_names() {
    const int n = from_text<int>("the number of names");
    for (int i = 0; i < n; ++i) {
      const int dimension = from_text<int>("a dimension"), number = from_text<int>("a physical number");
      const size_t open = text_.find_first_of("\"\n", text_.find_first_not_of(" \t", at_));
      const size_t close = open == std::string::npos ? open : text_.find_first_of("\"\n", open + 1);
      if (close == std::string::npos || text_[open] != '"' || text_[close] != '"') fail("expected a name in quotes");
      file_.names[{dimension, number}] = text_.substr(open + 1, close - open - 1);
      at_ = close + 1;
    }
  }

  // --- format 2.2
  // ---------------------------------------------------------------------------------------------------------
  void read_nodes_2() {
    const size_t n = count(from_text<int64_t>("the number of nodes"), "nodes");
    if (file_.is_binary) line_end();
    for (size_t i = 0; i < n; ++i) {
      file_.node_tag.push_back(get<int32_t>("a node number"));
      add_point();
    }
  }
  void add_point() {
    Vec3 p;
    for (int d = 0; d < 3; ++d) p[d] = get<double>("a coordinate");
    file_.x.push_back(p);
  }
  void read_elements_2() {
    const size_t n = count(from_text<int64_t>("the number of elements"), "elements");
    if (file_.is_binary) line_end();
    size_t done = 0;
    while (done < n) {
      if (file_.is_binary) {
        const int type = get<int32_t>("an element type");
        const size_t block = count(get<int32_t>("a number of elements"), "elements");
        const int tags = get<int32_t>("a number of tags");
        for (size_t i = 0; i < block; ++i, ++done) add_element_2(get<int32_t>("an element number"), type, tags);
      } else {
        const auto tag = from_text<int64_t>("an element number");
        const int type = from_text<int>("an element type");
        add_element_2(tag, type, from_text<int>("a number of tags"));
        ++done;
      }
    }
  }
  void add_element_2(int64_t tag, int type, int tags) {
    FileElement e = make_element(tag, type);
    for (int i = 0; i < tags; ++i)
      if (const int number = get<int32_t>("a tag"); i == 0 && number != 0) e.physical.push_back(std::abs(number));
    for (int a = 0; a < element_node_count(type); ++a) e.nodes[size_t(a)] = get<int32_t>("a node number");
    file_.elements.push_back(std::move(e));
  }
  FileElement make_element(int64_t tag, int type) const {
    if (element_node_count(type) == 0)
      fail(
          fmt::format("element {} is {}: only first-order hexahedra and tetrahedra (with their faces, edges and "
                      "points) are supported",
                      tag,
                      type == 6   ? "a prism"
                      : type == 7 ? "a pyramid"
                                  : fmt::format("of Gmsh type {}", type)));
    return {tag, type, {}, {}, at_};
  }

  // --- format 4.1
  // ---------------------------------------------------------------------------------------------------------
  int64_t get_size(const char* what) { return get<int64_t>(what); }
  void read_entities() {
    size_t counts[4];
    for (size_t& c : counts) c = count(get_size("a number of entities"), "entities");
    for (int dimension = 0; dimension < 4; ++dimension)
      for (size_t i = 0; i < counts[dimension]; ++i) {
        const int tag = get<int32_t>("an entity's number");
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) get<double>("a coordinate");
        auto& groups = groups_[{dimension, tag}];
        const size_t n = count(get_size("a number of physical groups"), "physical groups");
        for (size_t k = 0; k < n; ++k) groups.push_back(std::abs(get<int32_t>("a physical number")));
        if (dimension == 0) continue;
        const size_t bounds = count(get_size("a number of bounding entities"), "bounding entities");
        for (size_t k = 0; k < bounds; ++k) get<int32_t>("an entity's number");
      }
  }
  void read_nodes_4() {
    const size_t blocks = count(get_size("a number of blocks"), "blocks");
    for (int i = 0; i < 3; ++i) get_size("a count");
    for (size_t b = 0; b < blocks; ++b) {
      const int dimension = get<int32_t>("a dimension");
      get<int32_t>("an entity's number");
      const bool is_parametric = get<int32_t>("0 or 1") != 0;
      const size_t n = count(get_size("a number of nodes"), "nodes");
      for (size_t i = 0; i < n; ++i) file_.node_tag.push_back(get_size("a node number"));
      for (size_t i = 0; i < n; ++i) {
        add_point();
        for (int k = 0; is_parametric && k < dimension; ++k) get<double>("a parameter");
      }
    }
  }
  void read_elements_4() {
    const size_t blocks = count(get_size("a number of blocks"), "blocks");
    for (int i = 0; i < 3; ++i) get_size("a count");
    for (size_t b = 0; b < blocks; ++b) {
      const int dimension = get<int32_t>("a dimension"), entity = get<int32_t>("an entity's number"),
                type = get<int32_t>("an element type");
      const size_t n = count(get_size("a number of elements"), "elements");
      const auto groups = groups_.find({dimension, entity});
      for (size_t i = 0; i < n; ++i) {
        FileElement e = make_element(get_size("an element number"), type);
        for (int a = 0; a < element_node_count(type); ++a) e.nodes[size_t(a)] = get_size("a node number");
        if (groups != groups_.end()) e.physical = groups->second;
        file_.elements.push_back(std::move(e));
      }
    }
  }

  MeshFile& file_;
  const std::string& text_;
  size_t at_ = 0;
  bool is_4_ = false, is_swapped_ = false;
  std::map<std::pair<int, int>, std::vector<int>> groups_;  // physical groups of an entity (dimension, number)
};

}  // namespace

Mesh Gmsh::make() const {
  MeshFile raw;
  raw.path = file, raw.text = read_mesh_text(file, place), raw.repeats_elements = true;
  Reader(raw).read();
  return mesh_of(std::move(raw), elements, place);
}

}  // namespace bw::csd
