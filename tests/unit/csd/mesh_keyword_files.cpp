// SPDX-License-Identifier: Apache-2.0
// Abaqus and LS-DYNA files: the same two hexahedra and their sets from both; tetrahedra; what is refused, and where.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "common/app/error.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/hex.h"
#include "csd/mesh/input.h"
#include "csd/mesh/topology.h"

namespace bw::csd {
namespace {

template <class Kind>
Mesh read(const std::string& text, const std::vector<std::string>& only = {}, MeshQuality* quality = nullptr) {
  const auto path = std::filesystem::temp_directory_path() / ("csd_mesh_" + std::to_string(getpid()) + ".txt");
  std::ofstream(path) << text;
  Kind kind;
  kind.file = path, kind.elements = only, kind.place = "case.toml:1";
  MeshInput input;
  input.kind = kind, input.place = "case.toml:1";
  MeshQuality unused;
  Mesh mesh = make_mesh(input, quality ? *quality : unused);
  std::filesystem::remove(path);
  return mesh;
}
template <class Kind>
std::string refusal(const std::string& text, const std::vector<std::string>& only = {}) {
  try {
    read<Kind>(text, only);
  } catch (const InputError& e) {
    return e.what();
  }
  return "not refused";
}
#define EXPECT_SAYS(message, words) EXPECT_NE((message).find(words), std::string::npos) << (message)
std::string swap(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// nodes 1..12 of two unit cubes along x, node 99 of nothing
const std::string inp = R"(** two cubes
*Heading
 whatever, this is
*Part, name=Part-1
*Node
      1,           0.,           0.,           0.
      2,           1.,           0.,           0.
      3,           2.,           0.,           0.
      4,           0.,           1.,           0.
      5,           1.,           1.,           0.
      6,           2.,           1.,           0.
      7,  0., 0., 1.
      8,  1., 0., 1.
      9,  2., 0., 1.
     10,  0., 1., 1.
     11,  1., 1., 1.
     12,  2., 1., 1.
     99,  5., 5., 5.
*ELEMENT, TYPE=C3D8R, elset=Left
1, 1, 2, 5, 4,
   7, 8, 11, 10
*Element, type=C3D8R
2, 2, 3, 6, 5, 8, 9, 12, 11
*Elset, elset=Both, generate
 1, 2, 1
*Nset, nset=Foot
 1, 4, 7,
 10
*Nset, nset="Foot and more"
 Foot, 2
*Surface, type=ELEMENT, name=Front
 Both, S3
*Surface, type=ELEMENT, name=End
 2, S4
*End Part
*Material, name=STEEL
*Density
 7.8e-9,
)";
const std::string key = R"($ two cubes
*KEYWORD
*NODE
$     id               x               y               z
       1              0.              0.              0.       0       0
       2              1.              0.              0.       0       0
       3              2.              0.              0.       0       0
       4              0.              1.              0.
       5              1.              1.              0.
       6              2.              1.              0.
       7                                              1.
8,1.,0.,1.
       9              2.              0.              1.
      10              0.              1.              1.
      11              1.              1.              1.
      12              2.              1.              1.
      99              5.              5.              5.
*PART
Left
         1         1         1
A very long title
         7         1         1
*ELEMENT_SOLID
       1       1       1       2       5       4       7       8      11      10
       2       7
       2       3       6       5       8       9      12      11
*SET_NODE_LIST_TITLE
Foot
         5
         1         4         7        10
*SET_SOLID
        44
         1         2
*SET_SEGMENT_TITLE
Front
         6
         1         2         8         7
         2         3         9         8
*END
)";

void expect_two_cubes(const Mesh& mesh) {
  ASSERT_EQ(mesh.elem_count(), 2);
  ASSERT_EQ(mesh.node_count(), 12);  // the free node is left out
  double volume = 0;
  for (int e = 0; e < 2; ++e) volume += hex_volume(corners(mesh.hex[ElemId(e)], mesh.X)).volume;
  EXPECT_NEAR(volume, 2, 1e-14);
  EXPECT_EQ(mesh.elem_sets.at("Left").size(), 1u);
  ASSERT_EQ(mesh.node_sets.at("Foot").size(), 4u);
  for (NodeId n : mesh.node_sets.at("Foot")) EXPECT_EQ(mesh.X[n].x, 0);
  const FaceSum front = sum_faces(mesh, mesh.X, mesh.face_sets.at("Front"));
  EXPECT_LT(norm(front.area - Vec3{0, -2, 0}), 1e-14);
  EXPECT_EQ(mesh.node_sets.at("Front").size(), 6u);
}

TEST(AbaqusFile, NodesElementsSetsSurfaces) {
  const Mesh mesh = read<Abaqus>(inp);
  expect_two_cubes(mesh);
  EXPECT_EQ(mesh.elem_sets.at("Both").size(), 2u);
  EXPECT_EQ(mesh.node_sets.at("Foot and more").size(), 5u);
  EXPECT_LT(norm(sum_faces(mesh, mesh.X, mesh.face_sets.at("End")).area - Vec3{1, 0, 0}), 1e-14);
  EXPECT_EQ(read<Abaqus>(inp, {"Left"}).elem_count(), 1);
}

TEST(AbaqusFile, EverySideLooksOutward) {
  const Vec3 hex_normals[6] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  for (int side = 0; side < 6; ++side) {
    const Mesh mesh = read<Abaqus>(swap(inp, " 2, S4", " Left, S" + std::to_string(side + 1)), {"Left"});
    EXPECT_LT(norm(sum_faces(mesh, mesh.X, mesh.face_sets.at("End")).area - hex_normals[side]), 1e-14) << side;
  }
  const std::string tet =
      "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4,ELSET=T\n5,1,2,3,4\n*SURFACE,NAME=F\nT,S1\n";
  const Vec3 tet_areas[4] = {{0, 0, -.5}, {0, -.5, 0}, {.5, .5, .5}, {-.5, 0, 0}};
  for (int side = 0; side < 4; ++side) {
    const Mesh mesh = read<Abaqus>(swap(tet, "S1", "S" + std::to_string(side + 1)));
    EXPECT_EQ(mesh.elem_count(), 4);
    EXPECT_LT(norm(sum_faces(mesh, mesh.X, mesh.face_sets.at("F")).area - tet_areas[side]), 1e-14) << side;
  }
}

TEST(AbaqusFile, WrongOnesAreRefusedWithTheirLine) {
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "2, 2, 3, 6", "2, 2, 3, 77")), ".txt:23: element 2 uses node 77");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "type=C3D8R\n2", "type=C3D20\n2")), ".txt:22");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "2, 2, 3, 6, 5, 8, 9, 12, 11", "2, 2, 3, 6, 5, 8, 9")), "8 nodes");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "2, 2, 3", "1, 2, 3")), "element 1 is given twice");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, " 2, S4", " 2, S7")), "S1 .. S6");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, " 2, S4", " Bth, S4")), "Bth");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "           1.,           0.,           0.", " 1.0x, 0, 0")), ".txt:7:");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, " 1, 4, 7,\n 10", " 1, 4, 7,\n 777")), "777");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "*Material", "*Include, input=x\n*Material")), "x' can't be opened");
  EXPECT_SAYS(refusal<Abaqus>(inp, {"Lft"}), "Left");
  EXPECT_SAYS(refusal<Abaqus>("no mesh\n"), ":1");
  EXPECT_SAYS(refusal<Abaqus>(swap(inp, "2, 2, 3, 6, 5, 8, 9, 12, 11", "2, 1, 2, 5, 4, 7, 8, 11, 10")), "same nodes");
}

TEST(AbaqusFile, WrongOrientationIsMended) {
  MeshQuality quality;
  const Mesh mesh = read<Abaqus>(swap(inp, "2, 2, 3, 6, 5, 8, 9, 12, 11", "2, 8, 9, 12, 11, 2, 3, 6, 5"), {}, &quality);
  EXPECT_EQ(mesh.elem_count(), 2);
  EXPECT_EQ(quality.mended, 1);
}

TEST(LsDynaFile, NodesElementsPartsSets) {
  const Mesh mesh = read<LsDyna>(key);
  expect_two_cubes(mesh);
  EXPECT_EQ(mesh.elem_sets.at("A very long title").size(), 1u);
  EXPECT_EQ(mesh.elem_sets.at("44").size(), 2u);
  EXPECT_EQ(read<LsDyna>(key, {"A very long title"}).elem_count(), 1);
}

TEST(LsDynaFile, TetrahedraWithRepeatedNodes) {
  const Mesh mesh = read<LsDyna>(
      "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT_SOLID\n"
      "       1       1       1       2       3       4       4       4       4       4\n*SET_SEGMENT\n         1\n"
      "         1         3         2         2\n");
  EXPECT_EQ(mesh.elem_count(), 4);
  EXPECT_LT(norm(sum_faces(mesh, mesh.X, mesh.face_sets.at("1")).area - Vec3{0, 0, -.5}), 1e-14);
}

TEST(LsDynaFile, WrongOnesAreRefusedWithTheirLine) {
  EXPECT_SAYS(refusal<LsDyna>(swap(key, "       2       3       6       5", "       2       3      66       5")),
              "element 2 uses node 66");
  EXPECT_SAYS(refusal<LsDyna>(swap(key, "       2       3       6       5", "       2       3       6       3")),
              ".txt:26");
  EXPECT_SAYS(refusal<LsDyna>(
                  swap(key, "         1         4         7        10", "         1         4         7       100")),
              "100");
  EXPECT_SAYS(refusal<LsDyna>(swap(key, "*PART", "*INCLUDE\nmore.k\n*PART")), "more.k' can't be opened");
  EXPECT_SAYS(refusal<LsDyna>(swap(key, "*KEYWORD", "*NODE LONG=Y")), "format");
  EXPECT_SAYS(refusal<LsDyna>(
                  swap(key, "              2.              1.              0.", "              2.              q.")),
              ".txt:10");
}

TEST(Generators, BlockAndBall) {
  MeshQuality quality;
  MeshInput input;
  input.place = "case";
  Block block;
  block.corners = {{0, 0, 0}, {48, 44, 0}, {48, 60, 0}, {0, 44, 0}, {0, 0, 1}, {48, 44, 1}, {48, 60, 1}, {0, 44, 1}};
  block.cells = {4, 4, 1};
  input.kind = block;
  EXPECT_EQ(make_mesh(input, quality).face_sets.at("x_upper").size(), 4u);
  EXPECT_NEAR(quality.volume, 48 * (44 + 16) / 2.0, 1e-9);  // Cook's trapezium
  for (const char* sector : {"octant", "full"})
    for (const double inner : {0.0, 0.5}) {
      Ball ball;
      ball.radius = 1, ball.inner_radius = inner, ball.across = 6, ball.through = 6, ball.sector = sector;
      input.kind = ball;
      const Mesh mesh = make_mesh(input, quality);
      const double exact = 4 * std::numbers::pi / 3 * (1 - inner * inner * inner) / (ball.sector == "octant" ? 8 : 1);
      EXPECT_NEAR(quality.volume, exact, 0.02 * exact);
      EXPECT_GT(quality.min_scaled_jacobian, 0.4) << sector << inner;
      EXPECT_EQ(mesh.face_sets.at("outer").size(), ball.sector == "octant" ? 3u * 36 : 6u * 144);
      EXPECT_EQ(mesh.face_sets.contains("inner"), inner > 0);
      if (ball.sector == "octant") {
        EXPECT_EQ(mesh.face_sets.at("cut_y").size(), inner > 0 ? 2u * 36 : 3u * 36);
      }
    }
}

TEST(Quality, ReportsHistogramAndWorst) {
  Box b;
  b.cells = {3, 3, 3};
  Mesh mesh = b.make();
  EXPECT_TRUE(quality_report(check_mesh(mesh, "m", false)).empty());
  for (int n = 0; n < mesh.node_count(); ++n)  // one inner node towards a corner of the first element
    if (norm(mesh.X[NodeId(n)] - Vec3{1. / 3, 1. / 3, 1. / 3}) < 1e-9) mesh.X[NodeId(n)] = {0.17, 0.17, 0.17};
  const MeshQuality q = check_mesh(mesh, "m", false);
  int all = 0;
  for (int count : q.histogram) all += count;
  EXPECT_EQ(all, 27);
  ASSERT_FALSE(q.worst.empty());
  EXPECT_EQ(q.worst[0].gid, 0);
  EXPECT_EQ(q.worst[0].scaled_jacobian, q.min_scaled_jacobian);
  const auto lines = quality_report(q);
  ASSERT_GE(lines.size(), 2u);
  EXPECT_NE(lines[1].find("element 0"), std::string::npos) << lines[1];
}

/// A folder of files for *INCLUDE.
class Includes : public testing::Test {
 protected:
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("csd_include_" + std::to_string(getpid()));
  void SetUp() override { std::filesystem::create_directories(folder / "parts"); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  template <class Kind>
  Mesh mesh(const std::string& name) const {
    Kind kind;
    kind.file = folder / name, kind.place = "case.toml:1";
    return kind.make();
  }
  template <class Kind>
  std::string refusal_of(const std::string& name) const {
    try {
      mesh<Kind>(name);
    } catch (const InputError& e) {
      return e.what();
    }
    return "not refused";
  }
};
bool same_mesh(const Mesh& a, const Mesh& b) {
  if (a.node_sets != b.node_sets || a.elem_sets != b.elem_sets || a.face_sets != b.face_sets) return false;
  if (a.X.size() != b.X.size() || a.hex.size() != b.hex.size()) return false;
  return std::equal(a.X.begin(), a.X.end(), b.X.begin()) && std::equal(a.hex.begin(), a.hex.end(), b.hex.begin());
}

TEST_F(Includes, AbaqusPartsMakeTheSameMesh) {
  write("whole.inp", inp);
  const size_t nodes = inp.find("      1,  "), behind = inp.find("*ELEMENT"), sets = inp.find("*Nset, nset=Foot\n"),
               rest = inp.find("*Surface");
  write("main.inp", inp.substr(0, nodes) + "*INCLUDE, INPUT=parts/nodes.inp\n" + inp.substr(behind, sets - behind) +
                        "*include, input=\"parts/sets.inp\"\n" + inp.substr(rest));
  write("parts/nodes.inp", inp.substr(nodes, behind - nodes - 1));  // no end of line: data of the keyword before
  write("parts/sets.inp", "*Include, Input = more.inp\n" +
                              inp.substr(inp.find("*Nset, nset=\"Foot"), rest - inp.find("*Nset, nset=\"Foot")));
  write("parts/more.inp", inp.substr(sets, inp.find("*Nset, nset=\"Foot") - sets));
  EXPECT_TRUE(same_mesh(mesh<Abaqus>("main.inp"), mesh<Abaqus>("whole.inp")));
}

TEST_F(Includes, LsDynaPartsMakeTheSameMesh) {
  write("whole.k", key);
  const size_t nodes = key.find("*NODE"), parts = key.find("*PART"), elements = key.find("*ELEMENT_SOLID"),
               sets = key.find("*SET_NODE");
  write("main.k", key.substr(0, nodes) + "*INCLUDE\n$ two of them\nparts/nodes.k\nparts/parts.k\n" +
                      key.substr(elements, sets - elements) + "*INCLUDE\nparts/sets.k\n*END\nnonsense\n");
  write("parts/nodes.k", key.substr(nodes, parts - nodes) + "*END\n*NODE\nnot read\n");
  write("parts/parts.k", key.substr(parts, elements - parts));
  write("parts/sets.k", key.substr(sets));
  EXPECT_TRUE(same_mesh(mesh<LsDyna>("main.k"), mesh<LsDyna>("whole.k")));
}

TEST_F(Includes, ErrorsNameTheFileThatHoldsTheLine) {
  write("main.inp", "** one\n*NODE\n1, 0, 0, 0\n*INCLUDE, INPUT=parts/bad.inp\n*NODE\n2, nowhere, 0, 0\n");
  write("parts/bad.inp", "2, 1, 0, 0\n3, x, 0, 0\n");
  EXPECT_SAYS(refusal_of<Abaqus>("main.inp"), "parts/bad.inp:2: expected a coordinate, found 'x'");
  write("parts/bad.inp", "3, 1, 0, 0\n");
  EXPECT_SAYS(refusal_of<Abaqus>("main.inp"), "main.inp:6: expected a coordinate, found 'nowhere'");
  write("missing.inp", "*NODE\n*INCLUDE, INPUT=none.inp\n");
  EXPECT_SAYS(refusal_of<Abaqus>("missing.inp"), "missing.inp:2: mesh file '");
  write("empty.inp", "*INCLUDE\n");
  EXPECT_SAYS(refusal_of<Abaqus>("empty.inp"), "empty.inp:1: *INCLUDE without INPUT");
  write("circle.k", "*KEYWORD\n*INCLUDE\nparts/back.k\n");
  write("parts/back.k", "*INCLUDE\n../circle.k\n");
  EXPECT_SAYS(refusal_of<LsDyna>("circle.k"), "parts/back.k:2: the file '");
  EXPECT_SAYS(refusal_of<LsDyna>("circle.k"), "circle.k' includes itself");
  write("turned.k", "*INCLUDE_TRANSFORM\nparts/back.k\n");
  EXPECT_SAYS(refusal_of<LsDyna>("turned.k"), "turned.k:1: *INCLUDE_TRANSFORM is not supported");
}

}  // namespace
}  // namespace bw::csd
