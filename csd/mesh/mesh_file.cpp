// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/mesh_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <unordered_map>

#include "common/app/error.h"
#include "csd/mesh/check.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/hex.h"
#include "csd/mesh/tets.h"

namespace bw::csd {

int element_dimension(int type) { return type == 15 ? 0 : type == 1 ? 1 : type == 2 || type == 3 ? 2 : 3; }
int element_node_count(int type) {
  switch (type) {
    case 15:
      return 1;
    case 1:
      return 2;
    case 2:
      return 3;
    case 3:
    case 4:
      return 4;
    case 5:
      return 8;
    default:
      return 0;
  }
}

std::string MeshFile::at(size_t offset) const {
  if (is_binary) return fmt::format("{}: byte {}", path, offset);
  const auto behind = std::upper_bound(pieces.begin(), pieces.end(), offset,
                                       [](size_t value, const Piece& piece) { return value < piece.begin; });
  const Piece piece = behind == pieces.begin() ? Piece{0, path, 1} : behind[-1];
  const auto lines =
      std::count(text.begin() + long(piece.begin), text.begin() + long(std::min(offset, text.size())), '\n');
  return fmt::format("{}:{}", piece.path, piece.first_line + lines);
}

std::string MeshFile::group(int dimension, int number) const {
  const auto it = names.find({dimension, number});
  return it != names.end() ? it->second : std::to_string(number);
}

std::string read_mesh_text(const std::string& path, const std::string& place) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: mesh file '{}' can't be opened", place, path));
  std::ostringstream all;
  all << in.rdbuf();
  std::string text = std::move(all).str();
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // mark of UTF-8, of Windows editors
  return text;
}

namespace {

using namespace element_type;

/// Numbers the nodes of volume elements in file order.
class Points {
 public:
  explicit Points(const MeshFile& file) : file_(file) {
    for (size_t i = 0; i < file.node_tag.size(); ++i)
      if (!index_.try_emplace(file.node_tag[i], int32_t(i)).second)
        throw InputError(fmt::format("{}: node {} is given twice", file.path, file.node_tag[i]));
    number_.assign(file.x.size(), -1);
    for (const FileElement& e : file.elements)
      if (element_dimension(e.type) == 3)
        for (int a = 0; a < element_node_count(e.type); ++a) number_[size_t(index(e, a))] = 0;
    for (size_t i = 0; i < number_.size(); ++i)
      if (number_[i] == 0) {
        number_[i] = int32_t(x.size());
        x.push_back(file.x[i]);
      }
  }
  /// -1: the node is in no volume element.
  int32_t operator()(const FileElement& e, int a) const { return number_[size_t(index(e, a))]; }
  std::vector<Vec3> x;

 private:
  int32_t index(const FileElement& e, int a) const {
    const auto it = index_.find(e.nodes[size_t(a)]);
    if (it == index_.end())
      throw InputError(fmt::format("{}: element {} uses node {}, which is not in $Nodes", file_.at(e.offset), e.tag,
                                   e.nodes[size_t(a)]));
    return it->second;
  }
  const MeshFile& file_;
  std::unordered_map<int64_t, int32_t> index_;
  std::vector<int32_t> number_;
};

/// Leaves out volume elements that are in none of the named groups.
void keep_groups(MeshFile& file, const std::vector<std::string>& only, const std::string& place) {
  for (const std::string& name : only)
    if (std::none_of(file.names.begin(), file.names.end(),
                     [&](const auto& group) { return group.first.first == 3 && group.second == name; })) {
      std::string known;
      for (const auto& [key, group] : file.names)
        if (key.first == 3) known += (known.empty() ? "" : ", ") + group;
      throw InputError(fmt::format("{}: the mesh file has no element set \"{}\"; it has: {}", place, name,
                                   known.empty() ? "none" : known));
    }
  std::erase_if(file.elements, [&](const FileElement& e) {
    return element_dimension(e.type) == 3 && std::none_of(e.physical.begin(), e.physical.end(), [&](int number) {
             return std::find(only.begin(), only.end(), file.group(3, number)) != only.end();
           });
  });
}

/// Format 2.2 writes an element once for each of its physical groups: leaves one of them, with all the groups.
void join_repeated(MeshFile& file) {
  std::map<std::array<int64_t, 8>, size_t> first;
  std::vector<FileElement> kept;
  for (FileElement& e : file.elements) {
    if (element_dimension(e.type) == 3) {
      auto nodes = e.nodes;
      std::fill(nodes.begin() + element_node_count(e.type), nodes.end(), 0);
      const auto [it, is_new] = first.try_emplace(nodes, kept.size());
      FileElement& known = is_new ? e : kept[it->second];
      if (!is_new) {
        if (!file.repeats_elements || e.physical.empty() || e.physical == known.physical)
          throw InputError(
              fmt::format("{}: element {} has the same nodes as element {}", file.at(e.offset), e.tag, known.tag));
        known.physical.insert(known.physical.end(), e.physical.begin(), e.physical.end());
        continue;
      }
    }
    kept.push_back(std::move(e));
  }
  file.elements = std::move(kept);
}

using Quad = std::array<int32_t, 4>;
Quad sorted(Quad q) {
  std::sort(q.begin(), q.end());
  return q;
}

void check_distinct(const MeshFile& file, const FileElement& e) {
  for (int a = 0; a < element_node_count(e.type); ++a)
    for (int b = 0; b < a; ++b)
      if (const int64_t node = e.nodes[size_t(a)]; node == e.nodes[size_t(b)])
        throw InputError(fmt::format("{}: element {} uses node {} twice", file.at(e.offset), e.tag, node));
}

/// Nodes of the points, edges and faces that lower-dimensional elements name; the quads of the faces.
struct Named {
  std::map<std::string, std::set<int32_t>> nodes;
  std::map<Quad, std::set<std::string>> quads;
};
Named named_parts(const MeshFile& file, const Points& points, const TetSplit& split) {
  Named named;
  const auto add = [&](const std::string& name, const std::vector<int32_t>& nodes) {
    auto& set = named.nodes[name];
    for (const int32_t n : nodes)
      if (n >= 0) set.insert(n);
  };
  for (const FileElement& e : file.elements) {
    const int dimension = element_dimension(e.type);
    if (dimension == 3 || e.physical.empty()) continue;
    std::vector<int32_t> n;
    for (int a = 0; a < element_node_count(e.type); ++a) n.push_back(points(e, a));
    const bool is_in_volume = std::all_of(n.begin(), n.end(), [](int32_t i) { return i >= 0; });
    std::vector<Quad> quads;
    if (e.type == quadrangle && is_in_volume) quads.push_back({n[0], n[1], n[2], n[3]});
    if (e.type == triangle && is_in_volume)
      for (const Quad& q : split.quads_of({n[0], n[1], n[2]}))
        if (std::all_of(q.begin(), q.end(), [](int32_t i) { return i >= 0; })) quads.push_back(q);
    if (dimension == 1 && is_in_volume)
      if (const int32_t middle = split.middle_of(n[0], n[1]); middle >= 0) n.push_back(middle);
    for (const int number : e.physical) {
      const std::string name = file.group(dimension, number);
      add(name, n);
      for (const Quad& q : quads) {
        add(name, {q.begin(), q.end()});
        named.quads[sorted(q)].insert(name);
      }
    }
  }
  return named;
}

void add_face_sets(Mesh& mesh, const Named& named, const std::string& path) {
  for (const auto& [name, nodes] : named.nodes)
    for (const int32_t n : nodes) mesh.node_sets[name].push_back(NodeId(n));
  if (named.quads.empty()) return;
  Mesh mended = mesh;  // the sides that the elements will have once check_mesh has put their node order right
  mend_node_order(mended, path);
  for (const Face f : boundary_faces(mended, path)) {
    const auto q = mended.nodes_of(f);
    const auto it = named.quads.find(sorted({q[0], q[1], q[2], q[3]}));
    if (it == named.quads.end()) continue;
    for (const std::string& name : it->second) mesh.face_sets[name].push_back(f);
  }
}

}  // namespace

Mesh mesh_of(MeshFile raw, const std::vector<std::string>& only, const std::string& place) {
  if (!only.empty()) keep_groups(raw, only, place);
  join_repeated(raw);
  const Points points(raw);
  if (points.x.empty())
    throw InputError(place + ": mesh file '" + raw.path +
                     "': no volume elements (hexahedra or tetrahedra) in the file; were only surfaces meshed?");
  std::vector<std::array<int32_t, 4>> tets;
  for (const FileElement& e : raw.elements) {
    if (e.type != tetrahedron) continue;
    tets.push_back({points(e, 0), points(e, 1), points(e, 2), points(e, 3)});
    const auto at = [&](int a) { return points.x[size_t(tets.back()[size_t(a)])]; };
    if (triple(at(1) - at(0), at(2) - at(0), at(3) - at(0)) == 0)
      throw InputError(fmt::format("{}: tetrahedron {} has no volume", raw.at(e.offset), e.tag));
  }
  const TetSplit split(points.x, tets);
  Mesh mesh;
  for (size_t n = 0; n < split.x.size(); ++n) {
    mesh.X.push_back(split.x[n]);
    mesh.node_gid.push_back(int64_t(n));
    mesh.parent.push_back(NodeId());
  }
  size_t next = 0;  // hex of the split
  for (const FileElement& e : raw.elements) {
    if (element_dimension(e.type) != 3) continue;
    check_distinct(raw, e);
    for (int k = 0; k < (e.type == tetrahedron ? 4 : 1); ++k) {
      std::array<NodeId, 8> h;
      for (size_t a = 0; a < 8; ++a) h[a] = NodeId(e.type == hexahedron ? points(e, int(a)) : split.hexes[next][a]);
      if (e.type == tetrahedron) ++next;
      for (const int number : e.physical) mesh.elem_sets[raw.group(3, number)].push_back(ElemId(mesh.elem_count()));
      mesh.elem_gid.push_back(mesh.elem_count());
      mesh.hex.push_back(h);
      mesh.body.push_back(0);
    }
    if (e.type == hexahedron && valid_node_order(corners(mesh.hex[ElemId(mesh.elem_count() - 1)], mesh.X)) < 0)
      throw InputError(fmt::format("{}: hexahedron {} is inverted or has no volume", raw.at(e.offset), e.tag));
  }
  add_face_sets(mesh, named_parts(raw, points, split), raw.path);
  return mesh;
}

}  // namespace bw::csd
