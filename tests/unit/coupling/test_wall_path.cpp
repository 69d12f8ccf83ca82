// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupling/wall_path.h"

namespace bw::coupling {
namespace {

WetSurface nodes(int64_t topo, std::vector<int64_t> id, std::vector<int64_t> parent, std::vector<double> x, double v) {
  WetSurface s;
  s.topo_version = topo;
  for (const double xi : x) s.x.push_back({xi, 0, 0});
  s.v.assign(x.size(), {v, 0, 0});
  s.node_id = std::move(id);
  s.node_parent = std::move(parent);
  return s;
}

TEST(WallPath, RepaysTheGap) {
  WallPath path;
  path.begin({}, nodes(0, {1}, {-1}, {5}, 2));
  EXPECT_EQ(path.velocity(0.5)[0].x, 2);  // no gap yet
  path.end(0.5);
  EXPECT_EQ(path.x()[0].x, 6);
  path.begin({}, nodes(0, {1}, {-1}, {6.25}, 3));  // the solid went further than announced
  EXPECT_EQ(path.x()[0].x, 6);
  EXPECT_EQ(path.velocity(0.5)[0].x, 3 + 0.25 / 0.5);
  EXPECT_EQ(path.x()[0].x + 0.5 * path.velocity(0.5)[0].x, path.x_end(0.5)[0].x);
  path.end(0.5);
  EXPECT_EQ(path.x()[0].x, 7.75);
}

TEST(WallPath, Box1Jumps) {
  WallPath path;
  path.begin({.mean_pressure = false}, nodes(0, {1}, {-1}, {5}, 2));
  path.end(0.5);
  path.begin({.mean_pressure = false}, nodes(0, {1}, {-1}, {6.25}, 3));
  EXPECT_EQ(path.x()[0].x, 6.25);
  EXPECT_EQ(path.velocity(0.5)[0].x, 3);
}

TEST(WallPath, SplitNodesStartAtTheirParentsWall) {
  WallPath path;
  path.begin({}, nodes(0, {1, 2}, {-1, -1}, {5, 6}, 2));
  path.end(1);
  path.begin({}, nodes(1, {9, 8, 7, 2, 1}, {-1, 7, 2, -1, -1}, {3, 8.5, 8.5, 8.5, 7.5}, 2));
  EXPECT_EQ(path.x()[0].x, 3);  // newly wet, no parent
  EXPECT_EQ(path.x()[1].x, 8);  // split from 7, which was split from 2 in the same window
  EXPECT_EQ(path.x()[2].x, 8);
  EXPECT_EQ(path.x()[3].x, 8);
  EXPECT_EQ(path.x()[4].x, 7);
}

TEST(NodePlaces, DenseAndSparseIdsAreFound) {
  for (const int64_t stride : {int64_t(1), int64_t(5), int64_t(1000), int64_t(1) << 56}) {
    WetSurface s;
    for (const int64_t i : {40, -3, 17, 0, 5, 6, 39}) s.node_id.push_back(i * stride);
    const NodePlaces places(s);
    for (size_t i = 0; i < s.node_id.size(); ++i) {
      EXPECT_EQ(places.find(s.node_id[i]), int64_t(i)) << stride;
      EXPECT_EQ(places.find(s.node_id[i] + 2 * stride), -1) << stride;
    }
    EXPECT_TRUE(places.are_of(s));
  }
  EXPECT_EQ(NodePlaces().find(0), -1);
}

}  // namespace
}  // namespace bw::coupling
