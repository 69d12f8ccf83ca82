// SPDX-License-Identifier: Apache-2.0
// Break-up into pieces, eq (17) and VALIDATION C.1-C.9: sizes, rings, bins, cuts.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "common/app/error.h"
#include "csd/fracture/pieces.h"
#include "csd/fragments/fragments.h"
#include "csd/mesh/cylinder.h"
#include "csd/mesh/hex.h"

namespace bw::csd {
namespace {

TEST(FragmentSize, MottOfThePaper) {
  const double flow = 1.283e9 + 0.3 * 8.657e9;
  const RingState ring{0.1, 1500, flow, 7760};
  EXPECT_NEAR(Mott{}.width(ring), 8.909e-3, 2e-6);  // VALIDATION B
  Mott constant;
  constant.strength = 1.283e9;
  EXPECT_NEAR(constant.width(ring), 5.123e-3, 2e-6);
  // Gold's mass form: mu = sqrt(2/rho) (sigma/g)^1.5 (r/V)^3 = rho x0^3 / 2
  const double x0 = Mott{}.width(ring),
               mu = std::sqrt(2 / ring.density) * std::pow(flow / 56, 1.5) * std::pow(0.1 / 1500, 3);
  EXPECT_NEAR(0.5 * ring.density * x0 * x0 * x0, mu, 1e-12 * mu);
  EXPECT_NEAR(mu, 2.743e-3, 1e-6);  // C10
}

TEST(FragmentSize, GradyOfTheBrittleRing) {  // VALIDATION S10
  Grady law;
  law.energy = 100;
  const double expected[] = {206e-3, 44.4e-3, 9.56e-3, 2.06e-3, 0.444e-3};
  for (int k = 0; k < 5; ++k) {
    const double rate = std::pow(10.0, k + 1);
    EXPECT_NEAR(law.width({0.1, 0.1 * rate, 0, 2750}), expected[k], 5e-3 * expected[k]) << rate;
  }
}

Tube tube(int around, int along, double length = 0.4, int through = 2) {
  Tube t;
  t.inner_radius = 0.095, t.outer_radius = 0.105, t.length = length;
  t.around = around, t.through = through, t.along = along;
  return t;
}
double volume_of(const Mesh& m) {
  double sum = 0;
  for (const auto& h : m.hex) sum += hex_volume(corners(h, m.X)).volume;
  return sum;
}

/// A tube of which every element has the failure value given by its height, in motion as told.
struct Scene {
  Mesh mesh;
  Topology topology;
  Pieces pieces;
  double radius = 0.1, speed = 600;
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed, taken;
  Pieces::IsWhole is_whole = [](ElemId) { return false; };

  Scene(Mesh m, const PiecesInput& input) : mesh(std::move(m)), topology(mesh), pieces(input, mesh) {}
  int64_t advance(const std::function<double(double)>& fail_at, double t = 0) {
    std::vector<double> fail;
    for (const auto& h : mesh.hex) {
      double z = 0;
      for (const NodeId n : h) z += 0.125 * mesh.X[n].z;
      fail.push_back(fail_at(z));
    }
    std::vector<ElemId> broken;
    for (int e = 0; e < mesh.elem_count(); ++e)
      if (fail[size_t(e)] >= 1) broken.push_back(ElemId(e));
    std::stable_sort(broken.begin(), broken.end(),
                     [&](ElemId a, ElemId b) { return fail[size_t(a)] > fail[size_t(b)]; });
    const auto sample = [&](std::span<const ElemId> elems) {
      return std::vector<RingSample>(elems.size(), RingSample{1, radius, speed, 1e9, 7760});
    };
    return pieces.advance(mesh, topology, t, broken, fail, sample, splits, changed, taken, is_whole);
  }
  int parts() const {
    const auto piece = pieces_by_nodes(mesh);
    return int(std::set<int32_t>(piece.begin(), piece.end()).size());
  }
};
PiecesInput fixed(double width) {
  PiecesInput input;
  input.law = FixedWidth{width};
  return input;
}

TEST(FragmentPieces, EachRowHasAsManyAsItsWidthSays) {
  for (const bool is_split : {false, true}) {
    for (const int seed : {1, 2, 3}) {
      Tube t = is_split ? tube(64, 16, 0.4, 1) : tube(160, 60);
      t.is_split = is_split;
      PiecesInput input = fixed(0.0211);
      input.seed = seed;
      Scene s(t.make(), input);
      const double volume = volume_of(s.mesh);
      EXPECT_GT(s.advance([](double) { return 1.1; }), 0);
      for (int step = 0; step < 4; ++step) s.advance([](double) { return 1.1; });  // what rows shorter than l0 left
      ASSERT_EQ(s.topology.find_fault(s.mesh), "");
      EXPECT_EQ(volume_of(s.mesh), volume);
      const int wanted = int(std::lround(2 * std::numbers::pi * 0.1 / 0.0211));
      int bins = 0, elements = 0;
      std::set<double> phases;
      for (const Row& row : s.pieces.rows()) {
        EXPECT_EQ(row.bins, wanted);
        EXPECT_EQ(row.first_bin, bins);
        EXPECT_GE(row.ratio, 2.5);
        EXPECT_LE(row.ratio, 5);
        EXPECT_GE(row.across, 3);
        bins += row.bins, elements += row.elements;
      }
      EXPECT_EQ(elements, s.mesh.elem_count());  // rows are disjoint and leave nothing
      EXPECT_EQ(int(s.taken.size()), elements);
      EXPECT_EQ(s.parts(), bins);
      EXPECT_EQ(s.advance([](double) { return 1.2; }), 0);  // nothing is cut twice
      EXPECT_EQ(s.parts(), bins);
      // a piece is a bin: no piece holds elements of two
      const auto piece = pieces_by_nodes(s.mesh);
      std::set<std::pair<int32_t, int32_t>> pairs;
      for (int e = 0; e < s.mesh.elem_count(); ++e) pairs.insert({piece[ElemId(e)], s.pieces.bins()[ElemId(e)]});
      EXPECT_EQ(int(pairs.size()), bins);
    }
  }
}

TEST(FragmentPieces, FragmentsThatStayWholeAreNotCut) {
  const auto cut = [](bool with_whole) {
    Scene s(tube(160, 20).make(), fixed(0.0211));
    const auto is_whole = [&s](ElemId e) {
      for (const NodeId n : s.mesh.hex[e])
        if (s.mesh.X[n].x < -1e-9) return false;
      return true;
    };
    if (with_whole) s.is_whole = is_whole;
    for (int step = 0; step < 4; ++step) s.advance([](double) { return 1.1; });
    int opened = 0, binned = 0;
    for (int e = 0; e < s.mesh.elem_count(); ++e)
      for (int side = 0; side < 6; ++side) {
        const Face f{ElemId(e), side}, other = s.topology.partner(f);
        if (!other.elem.valid() || !is_whole(f.elem) || !is_whole(other.elem)) continue;
        opened += !s.topology.is_bonded(f), binned += s.pieces.bins()[f.elem] >= 0;
      }
    EXPECT_FALSE(s.taken.empty());
    return opened + binned;
  };
  EXPECT_EQ(cut(true), 0);
  EXPECT_GT(cut(false), 0);
}

TEST(FragmentPieces, RowsStartAtRandomAngles) {
  Scene s(tube(160, 60).make(), fixed(0.0211));
  s.advance([](double) { return 1.1; });
  ASSERT_GE(s.pieces.rows().size(), 3u);
  // angles at which a bin begins, in the middle layer of each row
  std::set<int> first_cuts;
  for (const Row& row : s.pieces.rows()) {
    std::vector<std::pair<double, int32_t>> around;
    for (int e = 0; e < s.mesh.elem_count(); ++e) {
      const int32_t bin = s.pieces.bins()[ElemId(e)];
      if (bin < row.first_bin || bin >= row.first_bin + row.bins) continue;
      Vec3 c;
      for (const NodeId n : s.mesh.hex[ElemId(e)]) c += 0.125 * s.mesh.X[n];
      around.push_back({std::atan2(c.y, c.x), bin});
    }
    std::sort(around.begin(), around.end());
    for (size_t i = 1; i < around.size(); ++i)
      if (around[i].second != around[0].second) {
        first_cuts.insert(int(std::lround(1e6 * around[i].first)));
        break;
      }
  }
  EXPECT_GE(first_cuts.size(), 2u);
}

TEST(FragmentPieces, ARingWaitsForItsMean) {
  Scene s(tube(48, 60).make(), fixed(0.0211));
  // l0 is 84 mm: the ring above z = 0.2 is broken in its lower third only
  EXPECT_EQ(s.advance([](double z) { return z > 0.2 && z < 0.228 ? 1.2 : 0.2; }), 0);
  EXPECT_TRUE(s.pieces.rows().empty());
  EXPECT_TRUE(s.pieces.holds(ElemId(0)));  // and doesn't open by itself meanwhile
  EXPECT_GT(s.advance([](double z) { return z > 0.2 && z < 0.3 ? 1.2 : 0.2; }), 0);
  ASSERT_EQ(s.pieces.rows().size(), 1u);
  EXPECT_GT(s.pieces.rows()[0].lower, 0.2);
  EXPECT_EQ(s.topology.find_fault(s.mesh), "");
}

TEST(FragmentPieces, NoSliversBetweenRows) {
  Scene s(tube(48, 120).make(), fixed(0.0211));
  s.advance([](double z) { return z > 0.25 ? 1.2 : 0.2; });
  s.advance([](double z) { return z > 0.1 ? 1.2 : 0.2; });
  s.advance([](double) { return 1.2; });
  for (const Row& row : s.pieces.rows()) EXPECT_GT(row.upper - row.lower, 0.5 * 2.5 * 0.0211 - 2 * 0.4 / 120);
  EXPECT_GE(s.pieces.rows().size(), 4u);
}

TEST(FragmentPieces, SlowRingsOpenByThemselves) {
  Scene s(tube(48, 60).make(), fixed(0.0211));
  s.speed = 5;
  EXPECT_EQ(s.advance([](double) { return 1.2; }), 0);
  EXPECT_FALSE(s.pieces.holds(ElemId(0)));
  s.speed = 50;
  EXPECT_GT(s.advance([](double) { return 1.2; }), 0);
  EXPECT_TRUE(s.pieces.holds(ElemId(0)));
}

TEST(FragmentPieces, ExemptPartsStayOut) {
  PiecesInput input = fixed(0.0211);
  input.range = {0.1, 0.3};
  Mesh m = tube(48, 60).make();
  for (int e = 0; e < m.elem_count(); ++e)
    if (m.X[m.hex[ElemId(e)][0]].z > 0.29) m.elem_sets["plug"].push_back(ElemId(e));
  input.exempt = {"plug"};
  Scene s(m, input);
  for (int step = 0; step < 4; ++step) s.advance([](double) { return 1.2; });
  for (int e = 0; e < s.mesh.elem_count(); ++e) {
    double z = 0;
    for (const NodeId n : s.mesh.hex[ElemId(e)]) z += 0.125 * s.mesh.X[n].z;
    const bool is_exempt = z < 0.1 || z > 0.3 || s.mesh.X[s.mesh.hex[ElemId(e)][0]].z > 0.29;
    EXPECT_EQ(s.pieces.bins()[ElemId(e)] < 0, is_exempt);
    EXPECT_EQ(s.pieces.holds(ElemId(e)), !is_exempt);
  }
  int bins = 0;
  for (const Row& row : s.pieces.rows()) bins += row.bins;
  EXPECT_EQ(s.parts(), bins + 2);  // each exempt end is one piece
  input.exempt = {"plag"};
  EXPECT_THROW(Pieces(input, m), InputError);
}

TEST(FragmentPieces, LayersOnRequest) {
  for (const bool layers : {false, true}) {
    PiecesInput input = fixed(0.012);
    input.layers = layers;  // 2.4 to 4.8 mm thick, of a wall of 10 mm with 6 elements
    Scene s(tube(160, 60, 0.4, 6).make(), input);
    for (int step = 0; step < 4; ++step) s.advance([](double) { return 1.2; });
    int bins = 0;
    for (const Row& row : s.pieces.rows()) {
      EXPECT_TRUE(layers ? row.layers >= 2 && row.layers <= 4 : row.layers == 1);
      EXPECT_EQ(row.bins, row.around * row.layers);
      bins += row.bins;
    }
    EXPECT_EQ(s.parts(), bins);
    EXPECT_EQ(s.topology.find_fault(s.mesh), "");
  }
}

}  // namespace
}  // namespace bw::csd
