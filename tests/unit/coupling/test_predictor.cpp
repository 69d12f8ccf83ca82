// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "coupling/predictor.h"
#include "coupling/substeps.h"

namespace bw::coupling {
namespace {

WetSurface nodes(int64_t topo, std::vector<int64_t> id, std::vector<int64_t> parent, std::vector<double> vx) {
  WetSurface s;
  s.topo_version = topo;
  for (const double v : vx) s.v.push_back({v, 0, 0});
  s.x = s.v;
  s.node_id = std::move(id);
  s.node_parent = std::move(parent);
  return s;
}

std::vector<Vec3> predict(WallPredictor& predictor, WetSurface surface, double dt_next) {
  predictor.predict(surface, dt_next);
  return surface.v;
}

TEST(Predictor, MiddleOfTheWindow) {
  WallPredictor predictor(Scheme::fluid_first);
  EXPECT_EQ(predict(predictor, nodes(0, {5, 6}, {-1, -1}, {1, 2}), 1)[1].x, 2);  // no history
  predictor.window_lasted(1);
  EXPECT_DOUBLE_EQ(predict(predictor, nodes(0, {5, 6}, {-1, -1}, {2, 4}), 1)[1].x, 1.5 * 4 - 0.5 * 2);
  predictor.window_lasted(1);
  // half a window is expected: v at its middle
  EXPECT_DOUBLE_EQ(predict(predictor, nodes(0, {5, 6}, {-1, -1}, {3, 6}), 0.5)[1].x, 6 + 0.25 * 2);
  predictor.window_lasted(0.01);
  // after a sliver the difference is not blown up by more than two
  EXPECT_DOUBLE_EQ(predict(predictor, nodes(0, {5, 6}, {-1, -1}, {3, 6.1}), 1)[1].x, 6.1 + (6.1 - 6));
}

TEST(Predictor, Box1KeepsTheLastVelocity) {
  WallPredictor predictor(Scheme::box1);
  predict(predictor, nodes(0, {5}, {-1}, {1}), 1);
  predictor.window_lasted(1);
  EXPECT_EQ(predict(predictor, nodes(0, {5}, {-1}, {3}), 1)[0].x, 3);
}

TEST(Predictor, SplitNodesContinueTheirParents) {
  WallPredictor predictor(Scheme::fluid_first);
  predict(predictor, nodes(0, {5, 6}, {-1, -1}, {1, 10}), 1);
  predictor.window_lasted(1);
  // 9 was split from 8, which was split from 6 in the same window; 20 was inside the body and is wet now; orders are
  // permuted
  const auto v = predict(predictor, nodes(1, {20, 9, 8, 6, 5}, {-1, 8, 6, -1, -1}, {7, 12, 12, 12, 2}), 1);
  EXPECT_EQ(v[0].x, 7);
  EXPECT_DOUBLE_EQ(v[1].x, 13);
  EXPECT_DOUBLE_EQ(v[2].x, 13);
  EXPECT_DOUBLE_EQ(v[3].x, 13);
  EXPECT_DOUBLE_EQ(v[4].x, 2.5);
}

TEST(Substeps, EqualAndExact) {
  EqualSubsteps sub(0.1, 0.4);
  int n = 0;
  double h = 0;
  while (!sub.done()) {
    h = sub.next(0.11);
    EXPECT_NEAR(h, 0.1, 1e-15);
    sub.advance();
    ++n;
  }
  EXPECT_EQ(n, 3);
  EXPECT_EQ(sub.t(), 0.4);  // to the last bit
}

TEST(Substeps, WholeRatioIsNotOneMore) {
  for (int k = 1; k < 2000; ++k) {
    const double t0 = 0.1 * k, dt = 1e-7 * k, t1 = t0 + 7 * dt;
    EqualSubsteps sub(t0, t1);
    int n = 0;
    for (; !sub.done(); ++n) sub.next((t1 - t0) / 7), sub.advance();
    EXPECT_EQ(n, 7);
  }
}

TEST(Substeps, TheRestIsDividedAnewWhenTheStepDrops) {
  EqualSubsteps sub(0, 1);
  EXPECT_DOUBLE_EQ(sub.next(0.3), 0.25);
  sub.advance();
  EXPECT_DOUBLE_EQ(sub.next(0.1), 0.75 / 8);
  sub.advance();
  EXPECT_DOUBLE_EQ(sub.next(0.5), 0.75 / 8);  // a larger one does not lengthen the steps of this window
  double last = 0;
  while (!sub.done()) last = sub.next(0.1), sub.advance();
  EXPECT_DOUBLE_EQ(last, 0.75 / 8);
  EXPECT_EQ(sub.t(), 1);
}

}  // namespace
}  // namespace bw::coupling
