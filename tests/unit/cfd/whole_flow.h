// SPDX-License-Identifier: Apache-2.0
// A whole flow from a case's text, for tests.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <fstream>

#include "cfd/books.h"
#include "cfd/build.h"
#include "cfd/step.h"
#include "common/app/machine.h"

namespace bw::cfd {

inline Comm world() {
  static int argc = 1;
  static char name[] = "unit_cfd", *list[] = {name, nullptr}, **argv = list;
  static Session session(argc, argv);
  return session.world();
}

inline Case read_text(const std::string& text) {
  CommandLine line;
  line.case_file = testing::TempDir() + "/flow_" + std::to_string(getpid()) + ".toml";
  std::ofstream(line.case_file) << "[time]\nend = 1\n" << text;
  return read_case(line);
}

struct Flow {
  Case cs;
  Model m;
  Sweep sweep;
  Books books;
  explicit Flow(const std::string& text, bool skip_quiet = true)
      : cs(read_text(text)), m(world(), cs), sweep(m.forest, m.setup, nullptr), books(m) {
    m.setup.skip_quiet = skip_quiet;
    paint(m, cs);
    sweep.fit();
    books.fit(m);
    books.refresh(m, all());
  }
  std::vector<int> all() const {
    std::vector<int> blocks;
    for (int b = 0; b < m.forest.local_blocks(); ++b) blocks.push_back(b);
    return blocks;
  }
  void steps(int n, double dt = 0) {
    for (int i = 0; i < n; ++i) {
      const double t = m.state.t, stable = cs.fluid.scheme.cfl / sweep.max_rate(m.state);
      coupling::Loads loads;
      m.state.t = t + step(m, sweep, books, dt > 0 ? std::min(dt, stable) : stable, nullptr, true, &loads);
    }
  }
  FluidSums sums() const { return books.sums(m); }
  std::vector<double> bits() const {
    std::vector<double> all_cells;
    for (int b : all()) all_cells.insert(all_cells.end(), m.state.block(b), m.state.block(b) + m.state.block_size());
    return all_cells;
  }
};

/// The same bits on 1 and 2 threads.
inline void expect_equal_on_threads(const std::string& text, int steps) {
  use_threads(1);
  Flow one(text);
  one.steps(steps);
  use_threads(2);
  Flow two(text);
  two.steps(steps);
  EXPECT_EQ(one.bits(), two.bits());
  EXPECT_EQ(one.sums().U[Cons::rhoE], two.sums().U[Cons::rhoE]);
}
/// Largest departures from 1 atm, and from the velocity v (or from rest) in units of `scale` [m/s].
struct Departure {
  double p = 0, v = 0;
};
inline Departure departure(const Flow& f, double v, double scale) {
  Departure worst;
  for (int b : f.all())
    for (int c = 0; c < f.m.forest.shape().cells(); ++c) {
      double U[Cons::most], W[Prim::most];
      for (int q = 0; q < f.m.state.rows(); ++q) U[q] = f.m.state.block(b, q)[c];
      std::visit([&](const auto& pair) { pair.to_primitive(U, W, Floors{}); }, f.m.setup.medium.mixture);
      worst.p = std::max(worst.p, std::abs(W[Prim::p] / 101325 - 1));
      worst.v = std::max(worst.v, std::abs(W[Prim::v] - v) / scale);
    }
  return worst;
}
/// Blocks at rest are passed over, and the bits are the same.
inline void expect_rest_is_skipped(const std::string& text, int steps) {
  Flow skip(text, true), all(text, false);
  skip.steps(steps, 2e-6), all.steps(steps, 2e-6);
  EXPECT_EQ(skip.bits(), all.bits());
  EXPECT_LT(skip.books.booked(skip.m).updates, all.books.booked(all.m).updates);
}

/// The case is refused, with a message that has `word` and the place in the file.
inline void expect_wrong(const std::string& text, const std::string& word) {
  try {
    Flow f(text);
    FAIL() << "accepted: " << text;
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(".toml:"), std::string::npos) << e.what();
  }
}
/// The text with its first `old` replaced.
inline std::string with(std::string text, const std::string& old, const std::string& now) {
  text.replace(text.find(old), old.size(), now);
  return text;
}

inline const std::string still_air = R"([[fluid.material]]
name = "air"
library = "air"
[[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
)";
inline const std::string air_flow = still_air + "velocity = [100, 50, 20]\n";
inline const std::string air_and_tnt = R"(
[[fluid.material]]
name = "TNT"
library = "TNT"
)" + still_air;
/// A ball of TNT's products, or of the explosive itself: `state` has the keys of its density and velocity; 1 atm.
inline std::string tnt_ball(const std::string& centre, double radius, const std::string& state) {
  return fmt::format("[[fluid.region]]\nshape = {{kind = \"sphere\", centre = {}, radius = {}}}\nmaterial = \"TNT\"\n",
                     centre, radius) +
         "pressure = 101325\n" + state;
}
/// A ball of TNT in air, lit at its centre.
inline std::string lit_charge(const std::string& centre, double radius) {
  return air_and_tnt + tnt_ball(centre, radius, "unburnt = true\n") + "[[fluid.burn]]\nmaterial = \"TNT\"\npoints = [" +
         centre + "]\n";
}
inline std::string grid(const std::string& cells, const std::string& upper, const std::string& boundary = "") {
  return "[fluid]\nlower = [0, 0, 0]\nupper = " + upper + "\ncells = " + cells + "\nboundary = {" + boundary + "}\n";
}
inline const char* periodic_sides =
    R"(x_lower = "periodic", x_upper = "periodic", y_lower = "periodic", y_upper = "periodic", z_lower = "periodic", z_upper = "periodic")";
inline const std::string hot_ball = R"([[fluid.region]]
shape = {kind = "sphere", centre = [0.31, 0.3, 0.28], radius = 0.17}
material = "TNT"
density = 400
pressure = 2e8
)";

}  // namespace bw::cfd
