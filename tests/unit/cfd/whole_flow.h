// SPDX-License-Identifier: Apache-2.0
// A whole flow from a case's text, for tests.
#pragma once
#include <gtest/gtest.h>

#include <unistd.h>

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
/// Blocks at rest are passed over, and the bits are the same.
inline void expect_rest_is_skipped(const std::string& text, int steps) {
  Flow skip(text, true), all(text, false);
  skip.steps(steps, 2e-6), all.steps(steps, 2e-6);
  EXPECT_EQ(skip.bits(), all.bits());
  EXPECT_LT(skip.books.booked(skip.m).updates, all.books.booked(all.m).updates);
}

inline const std::string air_flow = R"([[fluid.material]]
name = "air"
library = "air"
[[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
velocity = [100, 50, 20]
)";
inline const std::string air_and_tnt = R"(
[[fluid.material]]
name = "TNT"
library = "TNT"
[[fluid.material]]
name = "air"
library = "air"
[[fluid.region]]
shape = {kind = "everywhere"}
material = "air"
density = 1.225
pressure = 101325
)";
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
