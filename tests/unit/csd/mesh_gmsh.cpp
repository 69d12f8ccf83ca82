// SPDX-License-Identifier: Apache-2.0
// Gmsh files of both formats, as text and as bytes; what is wrong with a file is said with its place.
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/app/error.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/gmsh.h"
#include "csd/mesh/input.h"
#include "csd/mesh/topology.h"

namespace bw::csd {
namespace {

// A unit cube of hexahedra (two, along x) or tetrahedra (six), with a face group, a volume group and a node of no
// element.
struct Element {
  int type, dimension, group;
  std::vector<int> nodes;
};
struct Model {
  std::vector<std::array<double, 3>> nodes;  // tag = index + 1
  std::vector<Element> elements;
};
Model two_hexes() {
  Model m;
  m.nodes.push_back({9, 9, 9});  // the centre of an arc, say
  for (double z : {0., 1.})
    for (double y : {0., 1.})
      for (double x : {0., .5, 1.}) m.nodes.push_back({x, y, z});
  m.elements = {{15, 0, 5, {2}},
                {1, 1, 6, {2, 3}},
                {3, 2, 7, {2, 3, 6, 5}},
                {3, 2, 7, {3, 4, 7, 6}},
                {5, 3, 8, {2, 3, 6, 5, 8, 9, 12, 11}},
                {5, 3, 8, {3, 4, 7, 6, 9, 10, 13, 12}}};
  return m;
}
Model six_tets() {
  Model m;
  for (double z : {0., 1.})
    for (double y : {0., 1.})
      for (double x : {0., 1.}) m.nodes.push_back({x, y, z});
  m.elements = {{1, 1, 6, {1, 2}}, {2, 2, 7, {1, 2, 4}}, {2, 2, 7, {1, 4, 3}}};
  const int path[6][2] = {{2, 4}, {2, 6}, {3, 4}, {3, 7}, {5, 6}, {5, 7}};  // Kuhn: 1, a, b, 8
  for (const auto& p : path) m.elements.push_back({4, 3, 8, {1, p[0], p[1], 8}});
  return m;
}

class Bytes {
 public:
  explicit Bytes(bool is_swapped) : is_swapped_(is_swapped) {}
  template <class T>
  void put(T value) {
    char b[sizeof(T)];
    std::memcpy(b, &value, sizeof(T));
    if (is_swapped_) std::reverse(b, b + sizeof(T));
    text.append(b, sizeof(T));
  }
  std::string text;

 private:
  bool is_swapped_;
};

enum Kind { ascii, binary, swapped };
const std::string names =
    "$PhysicalNames\n4\n0 5 \"corner\"\n1 6 \"edge\"\n2 7 \"floor\"\n3 8 \"steel case\"\n$EndPhysicalNames\n";

std::string write22(const Model& m, Kind kind) {
  Bytes b(kind == swapped);
  const auto num = [&](auto v, const char* after) {
    if (kind == ascii)
      b.text += std::to_string(v) + after;
    else
      b.put(v);
  };
  b.text = std::string("$MeshFormat\n2.2 ") + (kind == ascii ? "0" : "1") + " 8\n";
  if (kind != ascii) b.put(int32_t(1)), b.text += "\n";
  b.text += "$EndMeshFormat\n" + names + "$Nodes\n" + std::to_string(m.nodes.size()) + "\n";
  for (size_t i = 0; i < m.nodes.size(); ++i) {
    num(int32_t(i + 1), " ");
    for (double x : m.nodes[i]) num(x, " ");
    if (kind == ascii) b.text += "\n";
  }
  b.text += "\n$EndNodes\n$Elements\n" + std::to_string(m.elements.size()) + "\n";
  for (size_t i = 0; i < m.elements.size(); ++i) {
    const Element& e = m.elements[i];
    if (kind == ascii)
      num(int32_t(i + 1), " "), num(e.type, " "), num(2, " ");
    else
      num(e.type, " "), num(1, " "), num(2, " "), num(int32_t(i + 1), " ");
    num(e.group, " "), num(e.group, " ");
    for (int n : e.nodes) num(n, " ");
    if (kind == ascii) b.text += "\n";
  }
  return b.text + "\n$EndElements\n";
}

std::string write41(const Model& m, Kind kind) {
  Bytes b(kind == swapped);
  const auto i32 = [&](int v) { kind == ascii ? void(b.text += std::to_string(v) + " ") : b.put(int32_t(v)); };
  const auto i64 = [&](int64_t v) { kind == ascii ? void(b.text += std::to_string(v) + " ") : b.put(v); };
  const auto real = [&](double v) { kind == ascii ? void(b.text += std::to_string(v) + " ") : b.put(v); };
  const auto line = [&] { b.text += kind == ascii ? "\n" : ""; };
  b.text = std::string("$MeshFormat\n4.1 ") + (kind == ascii ? "0" : "1") + " 8\n";
  if (kind != ascii) b.put(int32_t(1)), b.text += "\n";
  b.text += "$EndMeshFormat\n" + names + "$Entities\n";
  for (int d = 0; d < 4; ++d) i64(1);
  line();
  for (int d = 0; d < 4; ++d) {  // one entity of each dimension, number 1, in group 5 + d
    i32(1);
    for (int k = 0; k < (d == 0 ? 3 : 6); ++k) real(0.5);
    i64(1), i32(5 + d);
    if (d > 0) i64(2), i32(1), i32(-1);
    line();
  }
  b.text += "\n$EndEntities\n$Nodes\n";
  i64(2), i64(int64_t(m.nodes.size())), i64(1), i64(int64_t(m.nodes.size())), line();
  for (int part = 0; part < 2; ++part) {  // the first node with parameters, the others without
    const size_t first = part == 0 ? 0 : 1, last = part == 0 ? 1 : m.nodes.size();
    i32(part == 0 ? 1 : 3), i32(1), i32(part == 0), i64(int64_t(last - first)), line();
    for (size_t i = first; i < last; ++i) i64(int64_t(i + 1)), line();
    for (size_t i = first; i < last; ++i) {
      for (double x : m.nodes[i]) real(x);
      if (part == 0) real(0.25);
      line();
    }
  }
  b.text += "\n$EndNodes\n$Elements\n";
  i64(int64_t(m.elements.size())), i64(int64_t(m.elements.size())), i64(1), i64(int64_t(m.elements.size())), line();
  for (size_t i = 0; i < m.elements.size(); ++i) {
    const Element& e = m.elements[i];
    i32(e.dimension), i32(1), i32(e.type), i64(1), line();
    i64(int64_t(i + 1));
    for (int n : e.nodes) i64(n);
    line();
  }
  return b.text + "\n$EndElements\n$Periodic\nwhatever\n$EndPeriodic\n";
}

class File {
 public:
  explicit File(const std::string& text)
      : path((std::filesystem::temp_directory_path() / ("breakwave_" + std::to_string(::getpid()) + ".msh")).string()) {
    std::ofstream(path, std::ios::binary) << text;
  }
  ~File() { std::filesystem::remove(path); }
  std::string path;
};
Mesh read(const std::string& text) {
  const File file(text);
  Gmsh g;
  g.file = file.path;
  g.place = "case.toml:3";
  return g.make();
}
std::string error_of(const std::string& text) {
  try {
    Mesh m = read(text);
    check_mesh(m, "file.msh", false);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

class GmshFiles : public ::testing::TestWithParam<std::pair<int, Kind>> {};

TEST_P(GmshFiles, HexahedraWithTheirGroups) {
  const auto [format, kind] = GetParam();
  Mesh m = read(format == 22 ? write22(two_hexes(), kind) : write41(two_hexes(), kind));
  const MeshQuality q = check_mesh(m, "file", false);
  EXPECT_EQ(m.elem_count(), 2);
  EXPECT_EQ(m.node_count(), 12);  // without the node of no element
  EXPECT_NEAR(q.volume, 1, 1e-14);
  EXPECT_EQ(m.elem_sets.at("steel case").size(), 2u);
  EXPECT_EQ(m.face_sets.at("floor").size(), 2u);
  EXPECT_NEAR(sum_faces(m, m.X, m.face_sets.at("floor")).area.z, -1, 1e-14);
  EXPECT_EQ(m.node_sets.at("floor").size(), 6u);
  EXPECT_EQ(m.node_sets.at("edge").size(), 2u);
  EXPECT_EQ(m.node_sets.at("corner").size(), 1u);
}

TEST_P(GmshFiles, TetrahedraBecomeFourHexesEach) {
  const auto [format, kind] = GetParam();
  Mesh m = read(format == 22 ? write22(six_tets(), kind) : write41(six_tets(), kind));
  const MeshQuality q = check_mesh(m, "file", false);
  EXPECT_EQ(m.elem_count(), 24);
  EXPECT_EQ(m.node_count(), 8 + 19 + 18 + 6);  // corners, edges, faces, tets
  EXPECT_NEAR(q.volume, 1, 1e-14);
  EXPECT_EQ(m.elem_sets.at("steel case").size(), 24u);
  EXPECT_EQ(m.face_sets.at("floor").size(), 6u);
  EXPECT_NEAR(sum_faces(m, m.X, m.face_sets.at("floor")).area.z, -1, 1e-14);
  EXPECT_EQ(m.node_sets.at("edge").size(), 3u);
  EXPECT_EQ(Topology(m).find_fault(m), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, GmshFiles,
                         ::testing::Values(std::pair{22, ascii}, std::pair{22, binary}, std::pair{22, swapped},
                                           std::pair{41, ascii}, std::pair{41, binary}, std::pair{41, swapped}));

TEST(GmshGroups, AnElementWrittenOnceForEachGroupIsOneElement) {
  Model model = two_hexes();
  Element again = model.elements[4];
  again.group = 9;
  model.elements.push_back(again);
  const Mesh m = read(write22(model, ascii));
  EXPECT_EQ(m.elem_count(), 2);
  EXPECT_EQ(m.elem_sets.at("steel case").size(), 2u);
  EXPECT_EQ(m.elem_sets.at("9"), std::vector<ElemId>{ElemId(0)});
}

TEST(GmshErrors, NameTheirPlace) {
  const std::string good = write22(two_hexes(), ascii);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  const auto expect = [](const std::string& text, const std::string& part, const std::string& place = "") {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(part), std::string::npos) << "'" << error << "' lacks '" << part << "'";
    EXPECT_NE(error.find(place), std::string::npos) << error;
  };
  EXPECT_EQ(error_of(good), "");
  expect("", "expected a section", ".msh:1");
  expect("solid cube\nfacet", "expected a section", ".msh:1");
  expect(with("2.2 0 8", "4.0 0 8"), "format 4.0", ".msh:2");
  expect(with("2.2 0 8", "2.2 0 4"), "4 bytes", ".msh:2");
  expect(with("$Nodes\n13", "$Nodes\nmany"), "expected the number of nodes, found 'many'", ".msh:12");
  expect(with("$Nodes\n13", "$Nodes\n14"), "expected a node number, found '$EndNodes'", ".msh:");
  expect(with("$Nodes\n13", "$Nodes\n-3"), "-3 nodes", ".msh:");
  expect(with("$Nodes\n13", "$Nodes\n99999999999"), "more than the file can hold", ".msh:");
  expect(good.substr(0, good.find("$Nodes")), "no $Nodes");
  expect(good.substr(0, good.find("$Elements")), "no $Elements");
  expect(good.substr(0, good.size() - 30), "found", ".msh:");
  expect(with("2 3 6 5 8 9 12 11", "2 3 6 5 8 9 12 99"), "element 5 uses node 99", ".msh:34");
  expect(with("2 3 6 5 8 9 12 11", "2 3 6 5 8 9 12 12"), "element 5 uses node 12 twice", ".msh:34");
  expect(with("2 3 6 5 8 9 12 11", "2 6 3 5 8 9 12 11"), "hexahedron 5 is inverted", ".msh:34");
  expect(with("6 5 2 8 8", "6 6 2 8 8"), "a prism", ".msh:35");
  expect(with("6 5 2 8 8", "6 17 2 8 8"), "of Gmsh type 17", ".msh:35");
  expect(with("\n2 0.000000 0.000000", "\n1 0.000000 0.000000"), "node 1 is given twice");
  Model doubled = two_hexes();
  doubled.elements.push_back(doubled.elements[4]);
  expect(write22(doubled, ascii), "element 7 has the same nodes as element 5", ".msh:36");
  Model surface = two_hexes();
  surface.elements.resize(4);
  expect(write22(surface, ascii), "no volume elements");
  const std::string bytes = write41(two_hexes(), binary);
  expect(bytes.substr(0, bytes.size() / 2), "expected", "byte ");
  Gmsh missing;
  missing.file = "nowhere.msh";
  missing.place = "case.toml:3";
  try {
    missing.make();
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(std::string(e.what()), "case.toml:3: mesh file 'nowhere.msh' can't be opened");
  }
}

// any cut or flipped byte of a file ends in a mesh or an InputError, never in a crash
TEST(GmshErrors, BrokenBytesAreSurvived) {
  for (const std::string& good : {write22(two_hexes(), ascii), write41(six_tets(), ascii), write22(six_tets(), binary),
                                  write41(two_hexes(), binary)}) {
    for (size_t i = 0; i < good.size(); i += 7) {
      error_of(good.substr(0, i));
      std::string text = good;
      text[i] = char(text[i] ^ 0x15);
      error_of(text);
    }
  }
}

// --- wrong meshes, T19
// ----------------------------------------------------------------------------------------------------

TEST(MeshChecks, WrongNodeOrdersAreMended) {
  for (const std::vector<int>& order : {std::vector<int>{0, 3, 2, 1, 4, 7, 6, 5},
                                        {4, 5, 6, 7, 0, 1, 2, 3},
                                        {0, 1, 3, 2, 4, 5, 7, 6},
                                        {4, 5, 7, 6, 0, 1, 3, 2}}) {
    Model model = two_hexes();
    const auto nodes = model.elements[4].nodes;
    for (size_t a = 0; a < 8; ++a) model.elements[4].nodes[a] = nodes[size_t(order[a])];
    Mesh m = read(write22(model, ascii));
    EXPECT_EQ(m.face_sets.at("floor").size(), 2u);
    const MeshQuality q = check_mesh(m, "file", false);
    EXPECT_EQ(q.mended, 1);
    ASSERT_EQ(q.notes.size(), 1u);
    EXPECT_NEAR(q.volume, 1, 1e-14);
    EXPECT_NEAR(sum_faces(m, m.X, m.face_sets.at("floor")).area.z, -1, 1e-14);
    EXPECT_EQ(Topology(m).find_fault(m), "");
  }
}

Mesh hexes(const std::vector<Vec3>& x, const std::vector<std::array<int, 8>>& hex) {
  Mesh m;
  for (const Vec3& p : x) m.X.push_back(p), m.node_gid.push_back(m.node_count() - 1), m.parent.push_back(NodeId());
  for (const auto& h : hex) {
    std::array<NodeId, 8> nodes;
    for (size_t a = 0; a < 8; ++a) nodes[a] = NodeId(h[a]);
    m.hex.push_back(nodes), m.elem_gid.push_back(m.elem_count() - 1), m.body.push_back(0);
  }
  return m;
}
std::vector<Vec3> cube(Vec3 at) {
  std::vector<Vec3> x;
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 1},
                        Vec3{1, 1, 1}, Vec3{0, 1, 1}})
    x.push_back(at + p);
  return x;
}
const std::array<int, 8> first{0, 1, 2, 3, 4, 5, 6, 7};
std::string fault_of(Mesh m, bool may_have_pieces = false) {
  try {
    check_mesh(m, "body 'case'", may_have_pieces);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(MeshChecks, WrongMeshesAreRefused) {
  const auto expect = [](const std::string& fault, const std::string& part) {
    EXPECT_NE(fault.find(part), std::string::npos) << "'" << fault << "'";
  };
  EXPECT_EQ(fault_of(hexes(cube({}), {first})), "");
  expect(fault_of(Mesh{}), "no elements");
  auto twisted = cube({});
  std::swap(twisted[0], twisted[6]);
  expect(fault_of(hexes(twisted, {first})), "element 0 at (0.5, 0.5, 0.5) m is inverted");
  expect(fault_of(hexes(cube({}), {first, {3, 0, 1, 2, 7, 4, 5, 6}})), "duplicate");
  expect(fault_of(hexes(cube({}), {{0, 1, 2, 3, 4, 5, 6, 6}})), "a node twice");
  expect(fault_of(hexes(cube({}), {{0, 1, 2, 3, 4, 5, 6, 70}})), "node 70, which does not exist");
  auto more = cube({});
  more.push_back({5, 5, 5});
  expect(fault_of(hexes(more, {first})), "node 8 at (5, 5, 5) m belongs to no element");
  auto flat = cube({});
  for (Vec3& p : flat) p.z = 0;
  expect(fault_of(hexes(flat, {first})), "inverted");
  auto broken = cube({});
  broken[3].y = NAN;
  expect(fault_of(hexes(broken, {first})), "not a number");
  auto two = cube({});
  for (const Vec3& p : cube({3, 0, 0})) two.push_back(p);
  const std::vector<std::array<int, 8>> apart{first, {8, 9, 10, 11, 12, 13, 14, 15}};
  expect(fault_of(hexes(two, apart)), "2 unconnected pieces");
  EXPECT_EQ(fault_of(hexes(two, apart), true), "");
  // two cubes joined along one edge only
  auto hinge = cube({});
  for (const Vec3& p : {Vec3{2, 1, 0}, Vec3{2, 2, 0}, Vec3{1, 2, 0}, Vec3{2, 1, 1}, Vec3{2, 2, 1}, Vec3{1, 2, 1}})
    hinge.push_back(p);
  expect(fault_of(hexes(hinge, {first, {2, 8, 9, 10, 6, 11, 12, 13}})), "a hinge");
}

}  // namespace
}  // namespace bw::csd
