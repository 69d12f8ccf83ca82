// SPDX-License-Identifier: Apache-2.0
// Every kind of mesh: valid, of the right volume, with closed boundaries and the sets that it promises.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "csd/mesh/faces.h"
#include "csd/mesh/hex.h"
#include "csd/mesh/input.h"
#include "csd/mesh/topology.h"

namespace bw::csd {
namespace {

constexpr double pi = std::numbers::pi;

struct Made {
  Mesh mesh;
  MeshQuality quality;
};
Made make(const std::string& keys) {
  Keys k = Keys::read_text(keys);
  MeshInput input;
  input.describe(k);
  k.finish();
  Made made;
  made.mesh = make_mesh(input, made.quality);
  return made;
}

struct KindCase {
  std::string label, keys;
  double volume, band;  // m^3, relative
  std::vector<std::string> sets;
  double min_scaled;
};
void PrintTo(const KindCase& c, std::ostream* out) { *out << c.label; }
double polygon(int n) { return std::sin(2 * pi / n) * n / (2 * pi); }  // area over that of its circle
class Kinds : public ::testing::TestWithParam<KindCase> {};

TEST_P(Kinds, AreValidAndClosed) {
  const KindCase& c = GetParam();
  const Made m = make(c.keys);
  std::printf("%s: %s\n", c.label.c_str(), summary(m.quality).c_str());
  const Topology topology(m.mesh);
  EXPECT_EQ(topology.find_fault(m.mesh), "");
  EXPECT_EQ(m.quality.mended, 0);
  EXPECT_EQ(m.quality.pieces, 1);
  EXPECT_NEAR(m.quality.volume, c.volume, c.band * c.volume);
  EXPECT_GE(m.quality.min_scaled_jacobian, c.min_scaled);
  const FaceSum sum = sum_faces(m.mesh, m.mesh.X, topology.boundary());
  EXPECT_LT(norm(sum.area), 1e-13 * sum.area_norm);
  EXPECT_NEAR(sum.volume, m.quality.volume, 1e-12 * m.quality.volume);
  size_t in_sets = 0;
  for (const auto& name : c.sets) {
    ASSERT_TRUE(m.mesh.face_sets.count(name)) << name;
    EXPECT_FALSE(m.mesh.face_sets.at(name).empty()) << name;
    EXPECT_EQ(nodes_of_faces(m.mesh, m.mesh.face_sets.at(name)), m.mesh.node_sets.at(name)) << name;
    in_sets += m.mesh.face_sets.at(name).size();
  }
  EXPECT_EQ(in_sets, topology.boundary().size()) << "each boundary face in one set";
}

const std::vector<std::string> box_sets{"x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"};
const double ring = pi * (0.137 * 0.137 - 0.125 * 0.125) * 0.05 * polygon(64);
INSTANTIATE_TEST_SUITE_P(
    All, Kinds,
    ::testing::Values(
        KindCase{"box", "kind='box'\nlower=[0,0,0]\nupper=['1 m',2,'300 cm']\ncells=[2,3,4]", 6, 1e-13, box_sets,
                 0.999},
        KindCase{"box perturbed", "kind='box'\nlower=[0,0,0]\nupper=[1,1,1]\ncells=[5,5,5]\nperturb=0.2\nseed=7", 1,
                 1e-13, box_sets, 0.3},
        KindCase{"box graded", "kind='box'\nlower=[0,0,0]\nupper=[1,1,1]\ncells=[5,5,5]\ngrading=[4,1,0.5]", 1, 1e-13,
                 box_sets, 0.999},
        KindCase{"box split", "kind='box'\nlower=[0,0,0]\nupper=[1,1,1]\ncells=[2,2,2]\nsplit=true", 1, 1e-13, box_sets,
                 0.05},
        KindCase{"cylinder",
                 "kind='cylinder'\nradius='3.2 mm'\nlength='32.4 mm'\nacross=8\nalong=80",
                 pi * .0032 * .0032 * .0324 * polygon(32),
                 1e-12,
                 {"lower", "upper", "side"},
                 0.6},
        KindCase{"cylinder coarse",
                 "kind='cylinder'\nradius=1\nlength=2\nacross=2\nalong=2\naxis='x'",
                 pi * 2 * polygon(8),
                 1e-12,
                 {"lower", "upper", "side"},
                 0.4},
        KindCase{"cylinder thick core",
                 "kind='cylinder'\nradius=1\nlength=2\nacross=7\nalong=2",
                 pi * 2 * polygon(24),
                 1e-12,
                 {"lower", "upper", "side"},
                 0.5},
        KindCase{"quarter frustum",
                 "kind='cylinder'\nradius=1\nupper_radius=0.982\nlength=2\nacross=8\nalong=9\nsector='quarter'"
                 "\ngrading=0.3\nbase=[1,2,3]",
                 pi / 4 * 2 * (1 + .982 + .982 * .982) / 3 * polygon(32),
                 1e-12,
                 {"lower", "upper", "side", "cut_x", "cut_y"},
                 0.6},
        KindCase{
            "tube",
            "kind='tube'\ninner_radius='125 mm'\nouter_radius='137 mm'\nlength='50 mm'\naround=64\nthrough=2\nalong=4",
            ring,
            1e-12,
            {"inner", "outer", "lower", "upper"},
            0.99},
        KindCase{"half tube",
                 "kind='tube'\ninner_radius=0.125\nouter_radius=0.137\nlength=0.05\naround=64\nthrough=2\nalong="
                 "4\nsector='half'\naxis='y'",
                 ring / 2,
                 1e-12,
                 {"inner", "outer", "lower", "upper", "cut_x"},
                 0.99},
        KindCase{"quarter tube",
                 "kind='tube'\ninner_radius=0.125\nouter_radius=0.137\nlength=0.05\naround=64\nthrough=2\nalong="
                 "4\nsector='quarter'\naxis='x'",
                 ring / 4,
                 1e-12,
                 {"inner", "outer", "lower", "upper", "cut_y", "cut_z"},
                 0.99},
        KindCase{"tube split",
                 "kind='tube'\ninner_radius=0.125\nouter_radius=0.137\nlength=0.05\naround=64\nthrough=2\nalong="
                 "4\nsplit=true",
                 ring,
                 1e-12,
                 {"inner", "outer", "lower", "upper"},
                 0.03},
        KindCase{"sphere",
                 "kind='shell_of_revolution'\nshape='sphere'\nradius=0.1\nwall='2 mm'\naround=64\nthrough=2",
                 4. / 3 * pi*(std::pow(.1, 3) - std::pow(.098, 3)),
                 6e-3,
                 {"inner", "outer"},
                 0.4},
        KindCase{"can",
                 "kind='shell_of_revolution'\nshape='can'\nradius=0.05\nlength=0.2\nwall='5 mm'\nlower_wall='8 "
                 "mm'\naround=32\nthrough=2",
                 pi*(.05 * .05 * .2 - .045 * .045 * .187),
                 1e-2,
                 {"inner", "outer"},
                 0.4},
        KindCase{"capsule",
                 "kind='shell_of_revolution'\nshape='capsule'\nradius=0.05\nlength=0.3\nwall='5 "
                 "mm'\naround=48\nthrough=3\naxis='x'",
                 4. / 3 * pi*(std::pow(.05, 3) - std::pow(.045, 3)) + pi * .2 * (.05 * .05 - .045 * .045),
                 6e-3,
                 {"inner", "outer"},
                 0.4},
        KindCase{"points",
                 "kind='shell_of_revolution'\nshape='points'\nouter_z=[0,0,0.3,0.4]\nouter_r=[0,0.05,0.05,0]\ninner_z=["
                 "0.01,0.01,0.1,0.29,0.37]\n"
                 "inner_r=[0,0.04,0.04,0.04,0]\naround=32\nthrough=2",
                 pi * .05 * .05 * (.3 + .1 / 3) - pi * .04 * .04 * (.28 + .08 / 3),
                 1e-2,
                 {"inner", "outer"},
                 0.19}),
    [](const auto& info) {
      std::string label = info.param.label;
      for (char& ch : label)
        if (ch == ' ') ch = '_';
      return label;
    });

TEST(MeshKinds, ShellsHaveTwoClosedSurfacesAndAnExactCavity) {
  const Made m = make("kind='shell_of_revolution'\nshape='sphere'\nradius=0.1\nwall='2 mm'\naround=96\nthrough=2");
  for (const char* name : {"inner", "outer"}) {
    const auto& faces = m.mesh.face_sets.at(name);
    EXPECT_TRUE(is_closed(m.mesh, faces));
    const FaceSum sum = sum_faces(m.mesh, m.mesh.X, faces);
    EXPECT_LT(norm(sum.area), 1e-13 * sum.area_norm);
  }
  EXPECT_NEAR(m.quality.cavity_volume, 4. / 3 * pi * std::pow(.098, 3), 2e-3 * m.quality.cavity_volume);
}

TEST(MeshKinds, WeaponIsTheBodyOfTheValidation) {
  const Made m = make("kind='weapon'");
  std::printf("weapon demo: %s\n", summary(m.quality).c_str());
  EXPECT_GE(m.quality.elements, 8000);
  EXPECT_LE(m.quality.elements, 12000);
  EXPECT_GE(m.quality.min_scaled_jacobian, 0.25);
  EXPECT_EQ(Topology(m.mesh).find_fault(m.mesh), "");
  const Profile profile = Weapon{}.profile();
  const double exact = revolved_volume(profile.inner), metal = revolved_volume(profile.outer) - exact;
  EXPECT_NEAR(m.quality.cavity_volume, exact, 1e-2 * exact);
  std::printf("cavity %.6f m^3 = %.1f kg TNT; case %.1f kg of steel\n", exact, exact * 1630, metal * 7760);
  EXPECT_NEAR(exact * 1630, 88, 3);   // VALIDATION B: 87-89 kg
  EXPECT_NEAR(metal * 7760, 135, 6);  // 130-140 kg
  double top = 0;
  for (const Vec3& x : m.mesh.X) top = std::max(top, x.z);
  EXPECT_DOUBLE_EQ(top, 1.5);
  size_t parts = 0;
  for (const char* name : {"nose_plug", "base_plug", "wall"}) parts += m.mesh.elem_sets.at(name).size();
  EXPECT_EQ(parts, size_t(m.quality.elements));
  EXPECT_TRUE(is_closed(m.mesh, m.mesh.face_sets.at("inner")));
}

TEST(MeshKinds, SizesOfTheWeapon) {
  for (const auto& [size, low, high] : {std::tuple{"paper", 90'000, 115'000}, {"fine", 370'000, 440'000}}) {
    const Made m = make(std::string("kind='weapon'\nsize='") + size + "'");
    std::printf("weapon %s: %s\n", size, summary(m.quality).c_str());
    EXPECT_GE(m.quality.elements, low);
    EXPECT_LE(m.quality.elements, high);
    EXPECT_GE(m.quality.min_scaled_jacobian, 0.25);
  }
}

TEST(MeshKinds, WeaponThroughTetrahedra) {
  const Made m = make("kind='weapon'\nsplit=true\naround=48\nthrough=1");
  std::printf("weapon split: %s\n", summary(m.quality).c_str());
  EXPECT_GT(m.quality.min_scaled_jacobian, 0.02);
  EXPECT_TRUE(is_closed(m.mesh, m.mesh.face_sets.at("inner")));
  EXPECT_TRUE(is_closed(m.mesh, m.mesh.face_sets.at("outer")));
  EXPECT_EQ(Topology(m.mesh).find_fault(m.mesh), "");
}

// VALIDATION T1: the thick tube through tetrahedra, its inner nodes shaken by a quarter of their shortest edge
TEST(MeshKinds, ShakenSplitTubeIsValid) {
  const Made m = make(
      "kind='tube'\ninner_radius=0.125\nouter_radius=0.137\nlength=0.024\naround=128\nthrough=2\nalong=4\nsector='"
      "quarter'\nsplit=true\n"
      "perturb=0.25");
  std::printf("tube split and shaken: %s\n", summary(m.quality).c_str());
  EXPECT_GT(m.quality.min_scaled_jacobian, 0.05);
  const Made still = make(
      "kind='tube'\ninner_radius=0.125\nouter_radius=0.137\nlength=0.024\naround=128\nthrough=2\nalong=4\nsector='"
      "quarter'\nsplit=true");
  EXPECT_NEAR(m.quality.volume, still.quality.volume, 1e-13 * m.quality.volume);  // the boundary stays
}

TEST(MeshKinds, QuartersLieExactlyOnTheirPlanes) {
  const Made m = make("kind='cylinder'\nradius=1\nlength=2\nacross=6\nalong=2\nsector='quarter'");
  for (const NodeId n : m.mesh.node_sets.at("cut_x")) EXPECT_EQ(m.mesh.X[n].x, 0);
  for (const NodeId n : m.mesh.node_sets.at("cut_y")) EXPECT_EQ(m.mesh.X[n].y, 0);
}

TEST(MeshKinds, ScaleTurnMoveAndRegions) {
  const Made m = make(
      "kind='box'\nlower=[0,0,0]\nupper=[1,2,3]\ncells=[1,2,3]\nscale=0.001\nturn=90\nmove=['1 m',0,0]\n"
      "sets=[{name='end', upper=['0.999 m', 1, 1]}]");
  for (const Vec3& x : m.mesh.X) {
    EXPECT_LE(x.x, 1);
    EXPECT_GE(x.x, 0.998);
    EXPECT_GE(x.y, 0);
  }
  EXPECT_EQ(m.mesh.node_sets.at("end").size(), 16u);
  EXPECT_EQ(m.mesh.elem_sets.at("end").size(), 3u);
  EXPECT_EQ(m.mesh.face_sets.at("end").size(), 3u + 3 + 3 + 1 + 1);
  EXPECT_NEAR(m.quality.volume, 6e-9, 1e-20);
  EXPECT_THROW(make("kind='box'\nlower=[0,0,0]\nupper=[1,1,1]\ncells=[1,1,1]\nsets=[{name='none', lower=[2,2,2]}]"),
               InputError);
}

TEST(MeshKinds, BodiesMerge) {
  const Made a = make("kind='box'\nlower=[0,0,0]\nupper=[1,1,1]\ncells=[2,2,2]"),
             b = make("kind='tube'\ninner_radius=2\nouter_radius=3\nlength=1\naround=8\nthrough=1\nalong=1");
  const Mesh m = merge({a.mesh, b.mesh}, {"block", "ring"});
  EXPECT_EQ(m.elem_count(), 16);
  EXPECT_EQ(m.body[ElemId(15)], 1);
  EXPECT_EQ(m.elem_gid[ElemId(15)], 15);
  EXPECT_EQ(m.node_gid[NodeId(30)], 30);
  EXPECT_EQ(m.elem_sets.at("ring").size(), 8u);
  EXPECT_EQ(m.face_sets.at("inner"), m.face_sets.at("ring.inner"));
  EXPECT_EQ(m.face_sets.at("block.x_lower").size(), 4u);
  EXPECT_EQ(Topology(m).find_fault(m), "");
}

TEST(MeshKinds, WrongKeysAreInputErrors) {
  EXPECT_THROW(make("kind='box'\nlower=[0,0,0]\nupper=[1,1,0]\ncells=[1,1,1]"), InputError);
  EXPECT_THROW(make("kind='box'\nlower=[0,0,0]\nupper=[1,1,1]\ncells=[1,0,1]"), InputError);
  EXPECT_THROW(make("kind='shell_of_revolution'\nshape='sphere'\nradius=0.1\nwall=0.2\naround=64\nthrough=2"),
               InputError);
  EXPECT_THROW(make("kind='shell_of_revolution'\nshape='sphere'\nradius=0.1\nwall=0.01\naround=63\nthrough=2"),
               InputError);
  EXPECT_THROW(make("kind='sphere'"), InputError);
}

}  // namespace
}  // namespace bw::csd
