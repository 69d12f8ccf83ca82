// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "coupling/added_mass.h"
#include "coupling/predictor.h"

namespace bw::coupling {
namespace {

WetSurface faces(int64_t topo, std::vector<int64_t> id) {
  WetSurface s;
  s.topo_version = topo;
  s.face_id = std::move(id);
  return s;
}

TEST(AddedMass, LightestFaceDecides) {
  AddedMass limit(0.2);
  const std::vector<double> mass{10, 50}, impedance{1e6, 1e7};
  EXPECT_EQ(limit.longest_window(faces(0, {1, 2}), mass, 7e-9), 7e-9);  // nothing is known of the fluid yet
  EXPECT_DOUBLE_EQ(limit.answer(impedance, 1e-6), 1e7 * 1e-6 / 50);
  EXPECT_DOUBLE_EQ(limit.longest_window(faces(0, {1, 2}), mass, 1), 0.2 * 50 / 1e7);
  limit.answer(impedance, 1e-6);
  // face 2 is gone, 3 is new and unknown, 1 has moved
  EXPECT_DOUBLE_EQ(limit.longest_window(faces(1, {3, 1}), std::vector<double>{1, 10}, 1), 0.2 * 10 / 1e6);
  limit.answer({}, 1e-6);  // a fluid that does not know
  EXPECT_TRUE(std::isinf(limit.longest_window(faces(1, {3, 1}), std::vector<double>{1, 10}, 1)));
}

TEST(AddedMass, ZeroIsOff) {
  AddedMass limit(0);
  limit.longest_window(faces(0, {1}), std::vector<double>{1}, 1);
  limit.answer(std::vector<double>{1e9}, 1);
  EXPECT_TRUE(std::isinf(limit.longest_window(faces(0, {1}), std::vector<double>{1}, 1)));
}

/// The claim of the header: a free face against p = -Z v_wall decays for r < 1/2 and grows beyond.
TEST(AddedMass, StabilityBoundOfThePredictedWall) {
  const auto grows = [](double r) {
    double v = 1, v_before = 1, gap = 0, largest = 0;  // lengths in dt
    for (int i = 0; i < 2000; ++i) {
      const double v_pred = 1.5 * v - 0.5 * v_before, v_new = v - r * (v_pred + gap);
      gap = 0.5 * (v + v_new) - v_pred;
      v_before = v;
      v = v_new;
      if (i > 1000) largest = std::fmax(largest, std::abs(v));
    }
    return largest > 1;
  };
  EXPECT_FALSE(grows(0.2));
  EXPECT_FALSE(grows(0.48));
  EXPECT_TRUE(grows(0.52));
}

}  // namespace
}  // namespace bw::coupling
