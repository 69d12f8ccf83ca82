// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "cfd/overpressure.h"
#include "cfd/sample.h"
#include "tests/unit/cfd/whole_flow.h"

using namespace bw;
using namespace bw::cfd;

namespace {

/// p = 1e5 + 1e4 (x + 2 y - 3 z), v along x = 100 z, at rest otherwise, density 1 + y.
void paint_linear(Flow& f) {
  for (int b = 0; b < f.m.forest.local_blocks(); ++b) {
    const BlockShape& s = f.m.forest.shape(b);
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          const Vec3 x = f.m.forest.lower(b) + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z};
          double W[Prim::most] = {}, U[Cons::most];
          W[Prim::arho1] = 1 + x.y;
          W[Prim::v] = 100 * x.z;
          W[Prim::p] = 1e5 + 1e4 * (x.x + 2 * x.y - 3 * x.z);
          W[Prim::alpha1] = 1;
          std::visit([&](const auto& pair) { pair.to_conserved(W, U); }, f.m.setup.medium.mixture);
          for (int q = 0; q < Cons::count; ++q) f.m.state.block(b, q)[s.at(k, j, i)] = U[q];
        }
  }
  inspect(f.m, f.all());
}

}  // namespace

TEST(Overpressure, of_a_triangular_wave) {
  // rises from 0 at t = 1 to 50 at t = 2, falls to -25 at t = 3.5, ends at 0 at t = 4; sampled coarsely where it is
  // linear
  Overpressure w;
  w.begin(1000);
  const double t[] = {0, 1, 2, 3.5, 4}, p[] = {0, 0, 50, -25, 0};
  for (int i = 1; i < 5; ++i) w.add(t[i - 1], t[i], 1000 + p[i], 10);
  EXPECT_DOUBLE_EQ(w.peak, 50);
  EXPECT_DOUBLE_EQ(w.t_peak, 2);
  EXPECT_DOUBLE_EQ(w.arrival, 1.2);
  EXPECT_DOUBLE_EQ(w.end, 3);
  EXPECT_DOUBLE_EQ(w.duration(), 1.8);
  EXPECT_DOUBLE_EQ(w.positive_impulse, 25 + 25);
  EXPECT_DOUBLE_EQ(w.impulse, 50 - 0.5 * 0.5 * 25 - 0.5 * 0.5 * 25);
  // the same in small steps
  Overpressure fine;
  fine.begin(1000);
  for (int i = 1; i <= 4000; ++i) {
    const double a = (i - 1) * 1e-3, b = i * 1e-3;
    fine.add(a, b, 1000 + (b < 1 ? 0 : b < 2 ? 50 * (b - 1) : b < 3.5 ? 50 - 50 * (b - 2) : -25 + 50 * (b - 3.5)), 10);
  }
  EXPECT_NEAR(fine.arrival, 1.2, 1e-9);
  EXPECT_NEAR(fine.end, 3, 1e-9);
  EXPECT_NEAR(fine.positive_impulse, 50, 1e-6);
}

TEST(Overpressure, a_second_wave_does_not_reopen_the_positive_phase) {
  Overpressure w;
  w.begin(0);
  const double p[] = {0, -5, 20, -20, 40, 0};
  for (int i = 1; i < 6; ++i) w.add(i - 1, i, p[i], 1);
  EXPECT_DOUBLE_EQ(w.positive_impulse, 0.5 * 0.8 * 20 + 0.5 * 0.5 * 20);
  EXPECT_DOUBLE_EQ(w.end, 2.5);
  EXPECT_DOUBLE_EQ(w.peak, 40);
  Overpressure none;
  none.begin(100);
  none.add(0, 1, 50, 1);
  EXPECT_LT(none.arrival, 0);
  EXPECT_LT(none.duration(), 0);
  EXPECT_EQ(none.peak, 0);
}

TEST(Sampler, linear_fields_are_exact_inside) {
  world();
  Flow f(grid("[32, 24, 16]", "[1.6, 1.2, 0.8]", R"(x_upper = "outflow")") + air_flow);
  paint_linear(f);
  std::vector<Vec3> x;
  for (int i = 0; i < 200; ++i)
    x.push_back({0.05 + 1.5 * std::fmod(0.618034 * i, 1), 0.05 + 1.1 * std::fmod(0.7548777 * i, 1),
                 0.05 + 0.7 * std::fmod(0.5698403 * i, 1)});
  x.push_back({0.8, 0.6, 0.4});  // a corner of cells and of blocks
  x.push_back({0.025, 0.025, 0.025});
  Sampler s(x);
  std::vector<int> seen(x.size());
  double worst = 0;
  s.sample(
      f.m, [](int) { return false; },
      [&](size_t i, const FlowAt* w) {
        ++seen[i];
        const double p = 1e5 + 1e4 * (x[i].x + 2 * x[i].y - 3 * x[i].z);
        worst = std::max({worst, std::abs(w->p / p - 1), std::abs(w->rho / (1 + x[i].y) - 1),
                          std::abs(w->v.x - 100 * x[i].z) / 100});
      });
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(x.size()));
  EXPECT_LT(worst, 1e-13);
  RecordProperty("linear_field", std::to_string(worst));
}

TEST(Sampler, a_wall_is_no_neighbour) {
  world();
  Flow f(grid("[32, 24, 16]", "[1.6, 1.2, 0.8]") + air_flow);
  paint_linear(f);
  Sampler s({{0, 0.625, 0.425}, {0.01, 0.625, 0.425}, {0.025, 0.625, 0.425}});  // on the wall, beside it, at the centre
  std::vector<double> p(3);
  s.sample(
      f.m, [](int) { return false; }, [&](size_t i, const FlowAt* w) { p[i] = w->p; });
  EXPECT_NEAR(p[0], p[2], 1e-9 * p[2]);  // the mirror image has the same pressure
  EXPECT_NEAR(p[1], p[2], 1e-9 * p[2]);
}
