// SPDX-License-Identifier: Apache-2.0
// Walls over windows: loads, C11 (fluid's loss at links against face impulses), cracks, bodies thinner than their step.
#include <gtest/gtest.h>

#include "cfd/embed/body.h"
#include "cfd/embed/walls.h"
#include "embed_block.h"

namespace bw::cfd {
namespace {

using namespace test;

constexpr double p_ref = 101325;

/// OneBlock driven through Walls.
struct Windows {
  using Block = OneBlock<TwoGases>;
  Windows(const Lattice& g, GhostRule rule = GhostRule::mirror, bool conservative = false)
      : block(g, {}, rule),
        mixture(make_mixture(IdealGas{}, IdealGas{})),
        scheme(make_cut_scheme(mixture, block.shape)),
        walls(g, block.rules, g.n, p_ref, {.conservative = conservative}) {}

  void begin(const WetSurface& s) { begin(s, s.x); }
  void begin(const WetSurface& s, const std::vector<Vec3>& x_wall) {
    walls.begin(s, x_wall, s.v);
    block.map = walls.map();
    refill();
  }
  coupling::Loads step(double dt, const std::vector<Vec3>& x_end) {
    block.cuts.gather(walls.map(), walls.rules(), {});
    block.fill_patch();
    block.kernel.advance(block.patch, block.flow, dt, block.change, &scheme->prepare(block.patch, block.cuts, dt));
    exchange = {};
    links.clear();
    scheme->correct(block.change, exchange, walls.conservative() ? &links : nullptr);
    const auto r = walls.probes_of({});
    for (size_t i = r.first; i < r.last; ++i) {
      const Probe& p = walls.probes()[i];
      walls.set_load(i, scheme->load(p.cell, p.x + 0.5 * dt * p.v, p.n, p.v));
    }
    block.for_cells([&](int k, int j, int i) {
      if (block.blocked(k, j, i)) return;
      for (int q = 0; q < Cons::count; ++q) block.u[block.shape.at(k, j, i)][size_t(q)] += block.change.row(q, k, j)[i];
    });
    if (walls.conservative()) walls.set_links(links, dt);
    const coupling::Loads loads = walls.loads();
    walls.end(x_end);
    block.map = walls.map();
    refill();
    return loads;
  }
  void refill() {
    for (int layer = 1; layer <= walls.changes().layers; ++layer) {
      for (const FreshCell& f : walls.changes().fresh) {
        if (f.layer != layer) continue;
        double U[Cons::count];
        ASSERT_TRUE(cfd::refill(walls.map(), f.cell, mixture, {}, block.reader(), U));
        std::copy_n(U, int(Cons::count), block.u[block.shape.at(f.cell[2], f.cell[1], f.cell[0])].begin());
        ++refilled;
      }
      walls.accept(layer);
    }
  }

  Block block;
  Mixture mixture;
  std::unique_ptr<CutScheme> scheme;
  Walls walls;
  WallExchange exchange;
  std::vector<LinkLoad> links;
  int64_t refilled = 0;
};

Vec3 face_impulse(const WetSurface& s, const coupling::Loads& loads, double dt) {
  Vec3 sum;
  for (size_t f = 0; f < s.quads.size(); ++f) sum -= loads.p[f] * dt * coupling::area_vector(s.x, s.quads[f]);
  return sum;
}

TEST(EmbedWalls, NoNetForceInUniformPressure) {  // T8
  Windows run({{}, {0.05, 0.05, 0.05}, {20, 20, 20}});
  run.block.paint([](const Vec3&) { return gas(1.2, {}, 3e5); });
  WetSurface s = sphere({0.5, 0.5, 0.5}, 0.23, 7);
  append(s, box({0.1, 0.1, 0.1}, {0.13, 0.13, 0.13}));    // smaller than a cell
  append(s, box({0.8, 0.2, 0.2}, {0.801, 0.7, 0.7}, 5));  // thinner than a cell
  run.begin(s);
  const coupling::Loads loads = run.step(1e-5, s.x);
  EXPECT_EQ(loads.totals.dry_faces, 0);
  double area = 0;
  for (const auto& q : s.quads) area += norm(coupling::area_vector(s.x, q));
  EXPECT_LT(norm(face_impulse(s, loads, 1)), 1e-12 * 3e5 * area);
  for (const double p : loads.p) EXPECT_NEAR(p, 3e5, 1e-9 * 3e5);
  for (const double z : loads.impedance) EXPECT_NEAR(z, std::sqrt(1.4 * 3e5 * 1.2), 1e-6 * z);
}

Vec3 conservative_impulse(const WetSurface& s, const coupling::Loads& loads, double dt) {
  Vec3 sum = face_impulse(s, loads, dt);
  for (size_t f = 0; f < s.quads.size(); ++f)
    sum += norm(coupling::area_vector(s.x, s.quads[f])) * dt * loads.traction[f];
  return sum;
}

/// Faces get what the links across them gave: to round-off in the sum, without a net force or moment at rest; what that
/// costs in noise is told.
TEST(EmbedWalls, ConservativeLoads) {
  for (const double face : {0.5, 1.0, 2.0}) {  // its length in cells
    Windows run({{}, {0.05, 0.05, 0.05}, {20, 20, 20}}, GhostRule::mirror, true);
    run.block.paint([](const Vec3&) { return gas(1.2, {}, 3e5); });
    const WetSurface s = sphere({0.51, 0.48, 0.5}, 0.23, int(std::lround(0.23 * M_PI / 2 / (0.05 * face))));
    run.begin(s);
    const coupling::Loads loads = run.step(1e-5, s.x);
    double area = 0, square = 0;
    Vec3 moment;
    for (size_t f = 0; f < s.quads.size(); ++f) {
      const Vec3 A = coupling::area_vector(s.x, s.quads[f]);
      area += norm(A);
      square += norm(A) * std::pow(norm(loads.traction[f]) / (3e5 - p_ref), 2);
      moment += run.walls.face_forces().moment[f];
    }
    EXPECT_LT(norm(conservative_impulse(s, loads, 1)), 1e-12 * 3e5 * area);
    EXPECT_LT(norm(moment), 1e-12 * 3e5 * area * 0.23);
    RecordProperty(face == 0.5 ? "noise_half_cell"
                   : face == 1 ? "noise_one_cell"
                               : "noise_two_cells",
                   std::to_string(std::sqrt(square / area)));
    EXPECT_GT(square, 0);
  }
  Windows run({{}, {0.05, 0.05, 0.05}, {20, 20, 20}}, GhostRule::mirror, true);
  run.block.paint([](const Vec3& x) { return gas(1.2, {30 * x.y, 50, 20 * x.x}, 3e5 * (1 + x.x + 0.3 * x.z)); });
  const WetSurface s = sphere({0.51, 0.48, 0.5}, 0.23, 7);
  run.begin(s);
  const coupling::Loads loads = run.step(1e-5, s.x);
  EXPECT_LT(norm(conservative_impulse(s, loads, 1e-5) - run.exchange.momentum), 1e-12 * 3e5 * 1e-5);
  // a solid that has swollen beyond the fluid's walls, which are a prediction: its faces get the same impulse
  WetSurface swollen = s;
  for (Vec3& x : swollen.x) x += 0.05 * (x - Vec3{0.51, 0.48, 0.5});
  Windows ahead({{}, {0.05, 0.05, 0.05}, {20, 20, 20}}, GhostRule::mirror, true);
  ahead.block.paint([](const Vec3& x) { return gas(1.2, {30 * x.y, 50, 20 * x.x}, 3e5 * (1 + x.x + 0.3 * x.z)); });
  ahead.begin(swollen, s.x);
  const coupling::Loads told = ahead.step(1e-5, s.x);
  EXPECT_LT(norm(conservative_impulse(swollen, told, 1e-5) - ahead.exchange.momentum), 1e-12 * 3e5 * 1e-5);
}

TEST(EmbedWalls, FaceImpulsesMatchTheFluidsLoss) {  // C11
  for (const bool tilted : {false, true}) {
    Windows run({{}, {0.025, 0.025, 0.025}, {48, 32, 32}}, GhostRule::copy);
    run.block.paint([](const Vec3& x) {
      return x.x < 0.2 ? gas(1.225 * 2.6667, {1.25 * 340.29, 0, 0}, 4.5 * p_ref) : gas(1.225, {}, p_ref);
    });
    BodyCase b;
    b.shape = BoxShape{{0.413, 0.25, 0.25}, {0.613, 0.55, 0.55}};
    b.turn_angle = tilted ? 33 : 0;
    b.turn_axis = {0.3, 0.2, 1};
    b.turn_point = {0.513, 0.4, 0.4};
    Bodies bodies({b}, {{}, {1.2, 0.8, 0.8}, 0.025});
    const WetSurface s = bodies.at(0);
    run.begin(s);
    Vec3 faces, links;
    double t = 0, largest = 0;
    while (t < 6e-4) {
      const double dt = 0.6 / run.block.largest_rate();
      faces += face_impulse(s, run.step(dt, s.x), dt);
      links += run.exchange.momentum;
      largest = std::max(largest, norm(faces));
      t += dt;
    }
    const Vec3 gap = faces - links;
    std::printf("%s box: impulse on faces (%.4g %.4g %.4g) N s, lost at links (%.4g %.4g %.4g), differ by %.2f %%\n",
                tilted ? "tilted" : "straight", faces.x, faces.y, faces.z, links.x, links.y, links.z,
                100 * norm(gap) / norm(links));
    EXPECT_LT(norm(gap), 0.06 * norm(links));
  }
}

TEST(EmbedWalls, ACrackOpensNothingAndThenBlends) {
  // a bar splits in the middle; its halves fly apart
  auto half = [](double x0, double x1) { return box({x0, 0.35, 0.35}, {x1, 0.65, 0.65}, 4); };
  Windows run({{}, {0.05, 0.05, 0.05}, {24, 20, 20}});
  run.block.paint([](const Vec3&) { return gas(1.2, {}, 5e5); });
  WetSurface whole = half(0.2, 0.99);
  whole.topo_version = 1;
  run.begin(whole);
  const size_t links = run.walls.map().link_count();
  WetSurface s = half(0.2, 0.6);
  append(s, half(0.6, 0.99));
  s.topo_version = 2;
  for (size_t f = 0; f < s.quads.size(); ++f) {
    const Vec3 c = coupling::face_mean(s.x, s.quads[f]);
    if (std::abs(c.x - 0.6) < 1e-12) s.flags[f] = coupling::face_lip;
  }
  // nodes of both lips come from one
  for (size_t i = 0; i < s.x.size(); ++i) s.node_id[i] = 1000 + int64_t(i);
  for (size_t i = 0; i < s.x.size(); ++i)
    for (size_t k = 0; k < i; ++k)
      if (s.node_parent[i] < 0 && std::abs(s.x[i].x - 0.6) < 1e-12 && s.x[i] == s.x[k]) s.node_parent[i] = s.node_id[k];
  for (size_t i = 0; i < s.x.size(); ++i) s.v[i] = {i < s.x.size() / 2 ? -60.0 : 60.0, 0, 0};
  run.begin(s);
  EXPECT_GE(run.walls.map().link_count(), links);  // + links within metal
  EXPECT_TRUE(run.walls.changes().fresh.empty());
  EXPECT_TRUE(run.walls.changes().covered.empty());
  double before = p_ref;
  int64_t opened = 0;
  for (int step = 0; step < 80; ++step) {
    const double dt = 1.5e-5;
    std::vector<Vec3> x = s.x;
    for (size_t i = 0; i < x.size(); ++i) x[i] += dt * s.v[i];
    const coupling::Loads loads = run.step(dt, x);
    double on_lip = 0, count = 0;
    for (size_t f = 0; f < s.quads.size(); ++f)
      if (s.flags[f] & coupling::face_lip) on_lip += loads.p[f], ++count;
    on_lip /= count;
    EXPECT_GT(on_lip, before - 0.15 * p_ref);  // opens without jumps back
    EXPECT_LT(on_lip - before, 1e5);
    EXPECT_LT(on_lip, 1.05 * 5e5 * 1.2);
    before = on_lip;
    opened += int64_t(run.walls.changes().fresh.size());
    s.x = x;
    run.begin(s);
  }
  EXPECT_GT(opened, 30);
  EXPECT_GT(before, 4e5);
}

TEST(EmbedWalls, NewVelocitiesReachTheLinks) {
  Windows run({{}, {0.05, 0.05, 0.05}, {20, 20, 20}});
  WetSurface s = sphere({0.5, 0.5, 0.5}, 0.23, 7);
  run.begin(s);
  set_velocity(s, {3, 4, 5});
  run.begin(s);  // the same place
  int cuts = 0;
  for (int i = 0; i < 19; ++i)
    if (const CutLink* l = run.walls.map().link({i, 10, 10}, 0)) {
      ++cuts;
      EXPECT_EQ(l->below.v, (Vec3{3, 4, 5}));
      EXPECT_EQ(l->above.v, (Vec3{3, 4, 5}));
    }
  EXPECT_EQ(cuts, 2);
  for (const Probe& p : run.walls.probes()) EXPECT_LT(norm(p.v - Vec3{3, 4, 5}), 1e-15);
}

TEST(EmbedWalls, AFastThinBodyDoesNotMixItsSides) {
  // 5 mm of metal in cells of 50 mm, 15 mm a step: cells change sides without ever being covered
  Windows run({{}, {0.05, 0.05, 1}, {40, 8, 1}});
  BodyCase b;
  b.shape = BoxShape{{0.6, -1, -1}, {0.605, 2, 2}};
  Bodies bodies({b}, {{}, {2, 0.4, 1}, 0.2});
  WetSurface s = bodies.at(0);
  run.block.paint([](const Vec3& x) { return x.x > 0.6 ? gas(1.2, {}, p_ref) : gas_1(1.2, {}, p_ref); });
  for (Vec3& v : s.v) v = {300, 0, 0};
  run.begin(s);
  double crossed = 0;
  for (int step = 0; step < 40; ++step) {
    const double dt = std::min(5e-5, 0.5 / run.block.largest_rate());
    std::vector<Vec3> x = s.x;
    for (Vec3& a : x) a.x += dt * 300;
    run.step(dt, x);
    s.x = x;
    run.begin(s);
    double wall = 0;
    for (const Vec3& a : s.x) wall = std::max(wall, a.x);
    run.block.for_cells([&](int k, int j, int i) {
      if (run.walls.map().blocked({i, j, k})) return;
      const auto w = run.block.get(k, j, i);
      crossed = std::max(crossed, (i + 0.5) * 0.05 > wall ? std::abs(w[0]) : std::abs(w[1]));
    });
  }
  EXPECT_EQ(crossed, 0);
  EXPECT_GT(run.refilled, 30);
}

}  // namespace
}  // namespace bw::cfd
