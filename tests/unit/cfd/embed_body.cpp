// SPDX-License-Identifier: Apache-2.0
// Stand-alone bodies, cavities, probes and lips.
#include <gtest/gtest.h>

#include "cfd/embed/body.h"
#include "cfd/embed/cavity.h"
#include "cfd/embed/lips.h"
#include "cfd/embed/probes.h"
#include "cfd/embed/scan.h"
#include "cfd/embed/walls.h"
#include "common/app/error.h"
#include "common/io/keys.h"
#include "embed_surfaces.h"

namespace bw::cfd {
namespace {

using namespace test;

const Lattice grid{{}, {0.05, 0.05, 0.05}, {20, 20, 20}};
const ShapeSetting setting{{}, {1, 1, 1}, 0.05};

struct Scanned {
  bool watertight;
  double volume;
};
Scanned covered(const WetSurface& s) {
  CutMap map;
  Scanned r{scan(s, grid, map), 0};
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 20; ++i) r.volume += map.blocked({i, j, k}) ? 0.05 * 0.05 * 0.05 : 0;
  return r;
}
WetSurface body(const Shape& shape, double turn = 0) {
  BodyCase b;
  b.shape = shape;
  b.turn_angle = turn;
  b.turn_axis = {1, 2, 3};
  b.turn_point = {0.5, 0.5, 0.5};
  Bodies all({b}, setting);
  return all.at(0);
}

TEST(EmbedBody, ShapesAreWatertightAndOfTheirVolume) {
  for (const double turn : {0.0, 30.0, 77.0}) {
    for (const auto& [shape, volume] : std::vector<std::pair<Shape, double>>{
             {BoxShape{{0.2, 0.25, 0.3}, {0.8, 0.7, 0.6}}, 0.6 * 0.45 * 0.3},
             {SphereShape{{0.5, 0.5, 0.5}, 0.35}, 4.0 / 3 * M_PI * 0.35 * 0.35 * 0.35},
             {CylinderShape{{0.5, 0.5, 0.2}, {0.5, 0.5, 0.8}, 0.25}, M_PI * 0.25 * 0.25 * 0.6},
             {PistonShape{{0.5, 0.5, 0.5}, {1, 1, 0}}, 0.5},
             {PrismShape{{{0.2, 0.2, 0}, {0.8, 0.2, 0}, {0.8, 0.8, 0}, {0.5, 0.4, 0}, {0.2, 0.8, 0}}, {0.2, 0.8}},
              0.6 * (0.36 - 0.12)}}) {
      const WetSurface s = body(shape, turn);
      std::vector<int32_t> component;
      const auto exact = component_volumes(s, component);
      ASSERT_EQ(exact.size(), 1u);
      if (!std::holds_alternative<PistonShape>(shape)) {
        EXPECT_NEAR(exact[0] / volume, 1, 0.02) << shape.index();
      }
      const Scanned r = covered(s);
      EXPECT_TRUE(r.watertight) << shape.index();
      EXPECT_NEAR(r.volume / volume, 1, 0.05) << shape.index() << " turned " << turn;
      Vec3 sum;
      for (const auto& q : s.quads) sum += coupling::area_vector(s.x, q);
      EXPECT_LT(norm(sum), 1e-12 * std::pow(exact[0], 2.0 / 3));
    }
  }
  EXPECT_TRUE(covered(body(WedgeShape{{0.2, 0, 0}, 20, 2})).watertight);
  const WetSurface plate = body(PlaneShape{{0.5, 0.5, 0.5}, {1, 0, 0}, {}, {}});
  EXPECT_EQ(plate.flags[0], coupling::face_thin);
  EXPECT_EQ(covered(plate).volume, 0);
  CutMap map;
  scan(plate, grid, map);
  EXPECT_EQ(map.link_count(), 400u);
}

TEST(EmbedBody, MotionsIntegrateTheirVelocities) {
  const std::vector<Motion> motions{VelocityMotion{{3, 0, 0}, 0.2},
                                    TableMotion{{0.1, 0.5, 0.9}, {{0, 0, 0}, {4, 0, 0}, {-1, 2, 0}}},
                                    PulseMotion{{2, 1, 0}, 0.8, 0.1}, OscillationMotion{{1, 0, 2}, 3},
                                    RotationMotion{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 5}};
  for (const Motion& m : motions)
    std::visit(
        [](const auto& motion) {
          const Vec3 X{0.3, 0.4, 0.5};
          if constexpr (requires { motion.at(0); }) {
            EXPECT_LT(norm(motion.at(0)(X) - X), 1e-15);
          }
        },
        m);
  const PulseMotion pulse{{2, 0, 0}, 0.8, 0.1};
  const double d = 1e-6;
  for (double t = 0.05; t < 1; t += 0.07) {
    const double v = (pulse.at(t + d).shift.x - pulse.at(t - d).shift.x) / (2 * d);
    EXPECT_NEAR(v, t < 0.1 || t > 0.9 ? 0 : 2 * std::pow(std::sin(M_PI * (t - 0.1) / 0.8), 2), 1e-6);
  }
  const TableMotion table{{0.1, 0.5, 0.9}, {{0, 0, 0}, {4, 0, 0}, {-1, 0, 0}}};
  EXPECT_NEAR(table.at(0.3).shift.x, 0.2, 1e-14);
  EXPECT_NEAR(table.at(2).shift.x, 0.8 + 0.6 - 1.1, 1e-14);
  const OscillationMotion wave{{1, 0, 0}, 3};
  EXPECT_NEAR((wave.at(0.1 + d).shift.x - wave.at(0.1 - d).shift.x) / (2 * d), std::sin(6 * M_PI * 0.1), 1e-6);
  const RotationMotion turn{{1, 0, 0}, {0, 0, 1}, {}, 5};
  const Vec3 x = turn.at(M_PI / 10)({2, 0, 0});
  EXPECT_NEAR(x.x, 1, 1e-14);
  EXPECT_NEAR(x.y, 1, 1e-14);
}

TEST(EmbedBody, PolygonsThatCrossThemselves) {
  const Vec3 a{0.2, 0.2, 0}, b{0.8, 0.2, 0}, c{0.8, 0.8, 0}, d{0.2, 0.8, 0};
  EXPECT_TRUE((PrismShape{{a, c, b, d}, {}}.sides_cross()));
  EXPECT_FALSE((PrismShape{{a, b, c, d}, {}}.sides_cross()));
  EXPECT_FALSE((PrismShape{{d, c, b, a}, {}}.sides_cross()));
  // hollow: out to the inner square and back on the same way
  const Vec3 e{0.4, 0.4, 0}, f{0.4, 0.6, 0}, g{0.6, 0.6, 0}, h{0.6, 0.4, 0};
  EXPECT_FALSE((PrismShape{{a, b, c, d, a, e, f, g, h, e}, {}}.sides_cross()));
}

TEST(EmbedBody, ReadFromACase) {
  Keys keys = Keys::read_text(R"(
[[body]]
name = "ramp"
shape = {kind = "wedge", point = ["10 cm", 0, 0], angle = 20, length = "2 m"}
[[body]]
name = "piston"
shape = {kind = "piston", point = [0.5, 0, 0]}
motion = {kind = "pulse", velocity = ["100 m/s", 0, 0], duration = "1 ms"}
turn_angle = 30
)");
  std::vector<BodyCase> bodies;
  keys.tables("body", bodies, "bodies");
  keys.finish();
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_DOUBLE_EQ(std::get<WedgeShape>(bodies[0].shape).point.x, 0.1);
  EXPECT_DOUBLE_EQ(std::get<PulseMotion>(bodies[1].motion).duration, 1e-3);
  EXPECT_EQ(bodies[1].turn_angle, 30);
  EXPECT_TRUE(std::holds_alternative<FixedMotion>(bodies[0].motion));
  Bodies all(bodies, setting);
  EXPECT_FALSE(all.fixed());
  EXPECT_NEAR(all.positions(1e-3).back().x - all.positions(0).back().x, 0.05, 1e-12);
}

FreeMotion free_motion() {
  FreeMotion m;
  m.density = 3;
  return m;
}

TEST(EmbedRigid, MassPropertiesOfShapes) {
  const auto check = [](const Shape& shape, double volume, const Vec3& centre, const Vec3& inertia, double band) {
    const Facets f = std::visit([&](const auto& s) { return s.facets(ShapeSetting{{}, {1, 1, 1}, 0.01}); }, shape);
    const MassProperties m = solid_of(f.x, f.quads);
    EXPECT_NEAR(m.mass, volume, band * volume);
    EXPECT_LT(norm(m.centre - centre), 1e-12);
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(m.inertia(d, d), inertia[d], 2 * band * inertia[d]);
      EXPECT_NEAR(m.inertia(d, (d + 1) % 3), 0, 1e-12 * inertia[d]);
    }
  };
  const double V = 0.5 * 0.3 * 0.2;
  check(BoxShape{{0.1, 0.2, 0.3}, {0.6, 0.5, 0.5}}, V, {0.35, 0.35, 0.4},
        V / 12 * Vec3{0.09 + 0.04, 0.25 + 0.04, 0.25 + 0.09}, 1e-12);
  const double R = 0.3, ball = 4.0 / 3 * M_PI * R * R * R;
  check(SphereShape{{0.5, 0.4, 0.5}, R}, ball, {0.5, 0.4, 0.5}, 0.4 * ball * R * R * Vec3{1, 1, 1}, 1e-3);
}

/// Torque-free, asymmetric: angular momentum and energy; the axis of the largest moment stays near, order 2 in the
/// turn.
TEST(EmbedRigid, FreeFlightAndTumbling) {
  const MassProperties mass{2, {0.1, 0.2, 0.3}, {{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}}};
  const auto fly = [&](int steps) {
    RigidBody b(mass, {true, true, true, true, true, true}, {1, 2, 3}, {0.3, 2, 0.1});
    for (int i = 0; i < steps; ++i) b.advance(2.0 / steps, {}, {}, 0);
    EXPECT_LT(norm(b.centre() - Vec3{2.1, 4.2, 6.3}), 1e-12);
    return b;
  };
  const RigidBody coarse = fly(100), fine = fly(200), finest = fly(3200);
  EXPECT_EQ(coarse.angular_momentum(), finest.angular_momentum());
  const double e1 = norm(coarse.spin() - finest.spin()), e2 = norm(fine.spin() - finest.spin());
  EXPECT_LT(e1, 1e-2);
  EXPECT_GT(e1 / e2, 3.5);
  EXPECT_NEAR(finest.kinetic_energy(), 0.5 * 2 * 14 + 0.5 * (0.09 + 8 + 0.03), 1e-5);
  // a constant force and moment about a principal axis: exact at the end of each window but for the first's gap
  RigidBody pushed(mass, {true, false, true, false, true, false}, {}, {});
  for (int i = 0; i < 10; ++i) pushed.advance(0.1, {4, 5, 6}, {7, 0.2, 9}, 0);
  EXPECT_LT(norm(pushed.centre() - mass.centre - Vec3{1, 0, 1.5}), 1e-13);
  EXPECT_LT(norm(pushed.velocity() - Vec3{2, 0, 3}), 1e-13);
  EXPECT_LT(norm(pushed.spin() - Vec3{0, 0.1, 0}), 1e-13);
  EXPECT_NEAR(2 * std::atan2(pushed.after(1e-9).turn.u.y, pushed.after(1e-9).turn.w), 0.05, 1e-9);
}

/// Uniform pressure pushes and turns no closed body; faces without fluid take what is beside them; the rest p_ref.
TEST(EmbedRigid, LoadsOfAFreeBody) {
  BodyCase c;
  c.name = "a", c.shape = SphereShape{{0.5, 0.5, 0.5}, 0.3}, c.motion = free_motion(), c.turn_angle = 20;
  Bodies all({c}, setting);
  const size_t faces = all.at(0).quads.size();
  all.begin(2.0);
  const double at_first = all.largest_step();
  coupling::Loads loads;
  loads.p.assign(faces, 7.0), loads.impedance.assign(faces, 1.0);
  loads.p[5] = 1.0, loads.impedance[5] = 0;  // dry
  all.advance(0.01, loads, 1.0);
  const double scale = 6 * M_PI * 0.09;
  EXPECT_LT(norm(all.free()[0].rigid.state().force), 1e-13 * scale);
  EXPECT_LT(norm(all.free()[0].rigid.state().moment), 1e-13 * scale);
  // rho c A/m of a sphere: a third of its area
  EXPECT_NEAR(all.largest_step(), 0.3 * 4.0 / 3 * M_PI * 0.027 * 3 / (4.0 / 3 * M_PI * 0.09),
              0.02 * all.largest_step());
  EXPECT_NEAR(at_first, 0.5 * all.largest_step(), 0.02 * at_first);
  FaceForces facets;  // of cut cells: the loads know no rho c
  facets.met.assign(faces, 1), facets.force.assign(faces, {}), facets.moment.assign(faces, {});
  for (const auto& q : all.at(0).quads) facets.rho_c_area.push_back(2.0 * norm(coupling::area_vector(all.at(0).x, q)));
  loads.impedance.assign(faces, 0.0);
  all.advance(0.01, loads, 1.0, &facets);
  EXPECT_NEAR(all.largest_step(), at_first, 1e-9 * at_first);
  BodyCase plate = c;
  plate.thin = true;
  EXPECT_THROW(Bodies({plate}, setting), InputError);
}

TEST(EmbedCavity, SphericalShellHoldsItsCharge) {
  WetSurface s = body(SphereShape{{0.5, 0.5, 0.5}, 0.4}), inner = body(SphereShape{{0.5, 0.5, 0.5}, 0.33});
  for (auto& q : inner.quads) q = {q[0], q[3], q[2], q[1]};
  append(s, inner);
  CutMap map;
  EXPECT_TRUE(scan(s, grid, map));
  const Cavity c = find_cavity(s, map, {0.5, 0.52, 0.5});
  EXPECT_FALSE(c.reaches_boundary);
  EXPECT_NEAR(c.exact_volume, 4.0 / 3 * M_PI * std::pow(0.33, 3), 0.02 * c.exact_volume);
  EXPECT_NEAR(c.cell_volume, c.exact_volume, 0.02 * c.exact_volume);
  EXPECT_TRUE(find_cavity(s, map, {0.01, 0.01, 0.01}).reaches_boundary);
  EXPECT_TRUE(find_cavity(s, map, {0.5, 0.5, 0.13}).cells.empty());
  // a shell much thinner than a cell
  for (Vec3& x : s.x)
    if (norm(x - Vec3{0.5, 0.5, 0.5}) > 0.36) x = Vec3{0.5, 0.5, 0.5} + (0.331 / 0.4) * (x - Vec3{0.5, 0.5, 0.5});
  scan(s, grid, map);
  const Cavity thin = find_cavity(s, map, {0.5, 0.52, 0.5});
  EXPECT_FALSE(thin.reaches_boundary);
  EXPECT_NEAR(thin.cell_volume, thin.exact_volume, 0.02 * thin.exact_volume);
}

TEST(EmbedProbes, EachFaceAsksOnItsOwnSide) {
  // a shell thinner than a cell: outer faces outside, inner faces inside
  WetSurface s = sphere({0.5, 0.5, 0.5}, 0.34, 10), inner = sphere({0.5, 0.5, 0.5}, 0.33, 10);
  for (auto& q : inner.quads) q = {q[0], q[3], q[2], q[1]};
  append(s, inner);
  CutMap map;
  scan(s, grid, map);
  const auto probes = find_probes(s, map);
  EXPECT_EQ(probes.size(), s.quads.size());
  for (const Probe& p : probes) {
    const double r = norm(grid.centre(p.cell) - Vec3{0.5, 0.5, 0.5});
    EXPECT_TRUE(size_t(p.face) < s.quads.size() / 2 ? r > 0.33 : r < 0.34);
  }
  // a plate has two sides, lips on each other none
  const auto both = find_probes(plate({0.5, 0.5, 0.5}, {0, 0.5, 0}, {0, 0, 0.5}, 2), [&] {
    static CutMap m;
    scan(plate({0.5, 0.5, 0.5}, {0, 0.5, 0}, {0, 0, 0.5}, 2), grid, m);
    return std::ref(m);
  }());
  EXPECT_EQ(both.size(), 8u);
  WetSurface two = box({0.1, 0.1, 0.1}, {0.5, 0.9, 0.9});
  append(two, box({0.5, 0.1, 0.1}, {0.9, 0.9, 0.9}));
  scan(two, grid, map);
  EXPECT_EQ(find_probes(two, map).size(), 10u);
  // outside the grid
  WetSurface gone = box({3, 3, 3}, {4, 4, 4});
  scan(gone, grid, map);
  EXPECT_TRUE(find_probes(gone, map).empty());
}

TEST(EmbedLips, TwinsAreFoundThroughSplits) {
  WetSurface s;
  s.x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0.1}, {1, 0, 0.1}, {1, 1, 0.1}, {0, 1, 0.1}};
  s.node_id = {10, 11, 12, 13, 20, 21, 22, 33};
  s.node_parent = {-1, -1, -1, -1, 10, 11, 12, 30};
  s.quads = {{0, 1, 2, 3}, {5, 4, 7, 6}, {0, 1, 5, 4}};
  s.flags = {coupling::face_lip, coupling::face_lip, coupling::face_lip};
  finish(s);
  WetSurface before = s;  // node 30 was split from 13 earlier
  before.node_id[7] = 30;
  before.node_parent[7] = 13;
  Lips lips;
  lips.pair(before);
  lips.pair(s);
  EXPECT_NEAR(lips.aperture(s, 0), 0.1, 1e-15);
  EXPECT_NEAR(lips.aperture(s, 1), 0.1, 1e-15);
  EXPECT_GT(lips.aperture(s, 2), 1e6);
}

}  // namespace
}  // namespace bw::cfd
