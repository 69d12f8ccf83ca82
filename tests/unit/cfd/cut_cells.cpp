// SPDX-License-Identifier: Apache-2.0
// Moving cut cells: geometry against exact volumes, conservation, and gas that moves with its walls.
#include <numeric>

#include "cfd/cut/geometry.h"
#include "common/app/error.h"
#include "embed_surfaces.h"
#include "whole_flow.h"

namespace bw::cfd {
namespace {

using namespace test;

/// Turned about z, then about x, through the middle of the unit box.
void turn(coupling::WetSurface& s, double about_z, double about_x) {
  for (Vec3& x : s.x) {
    Vec3 r = x - Vec3{0.5, 0.5, 0.5};
    r = {std::cos(about_z) * r.x - std::sin(about_z) * r.y, std::sin(about_z) * r.x + std::cos(about_z) * r.y, r.z};
    r = {r.x, std::cos(about_x) * r.y - std::sin(about_x) * r.z, std::sin(about_x) * r.y + std::cos(about_x) * r.z};
    x = r + Vec3{0.5, 0.5, 0.5};
  }
}

struct Room {
  Lattice lattice;
  CutGeometry cut;
  Room(const coupling::WetSurface& s, Index3 n) : lattice{{0, 0, 0}, {1.0 / n[0], 1.0 / n[1], 1.0 / n[2]}, n} {
    cut.build(s, s.x, std::vector<Vec3>(s.x.size()), lattice);
  }
  double volume_of(const Index3& c) const {
    const CutVolume* v = cut.find(c);
    return v ? v->volume : cut.open(c);
  }
  double volume() const {
    double sum = 0;
    for (int k = 0; k < lattice.n[2]; ++k)
      for (int j = 0; j < lattice.n[1]; ++j)
        for (int i = 0; i < lattice.n[0]; ++i) sum += volume_of({i, j, k});
    return sum * lattice.h.x * lattice.h.y * lattice.h.z;
  }
};

TEST(CutCells, VolumesAreExact) {
  for (const double angle : {0.0, 0.3, 1.1}) {
    coupling::WetSurface s = box({0.25, 0.3, 0.35}, {0.75, 0.7, 0.6}, 3);
    turn(s, angle, 0.7 * angle);
    EXPECT_NEAR(Room(s, {16, 20, 12}).volume(), 1 - 0.5 * 0.4 * 0.25, 1e-13) << angle;
  }
  // faces in grid planes, nodes off them by less than round-off
  coupling::WetSurface s = box({0.25, 0.25, 0.25}, {0.75, 0.5, 0.625}, 2);
  for (Vec3& x : s.x) x.x += 1e-15;
  const Room room(s, {8, 8, 8});
  EXPECT_NEAR(room.volume(), 1 - 0.5 * 0.25 * 0.375, 1e-13);
  EXPECT_EQ(room.volume_of({4, 3, 3}), 0);
  EXPECT_EQ(room.volume_of({1, 3, 3}), 1);
}

TEST(CutCells, ABodyAsLongAsAFlowOfOneCellGoesThroughIt) {
  const Room plane(box({0.25, 0.25, 0}, {0.75, 0.5, 1}, 2), {8, 8, 1}), tube(box({0.3, 0, 0}, {0.75, 1, 1}, 2), {8, 1, 1});
  EXPECT_NEAR(plane.volume(), 1 - 0.5 * 0.25, 1e-13);
  EXPECT_NEAR(tube.volume(), 1 - 0.45, 1e-13);
  for (const Room* room : {&plane, &tube})  // no facets across a direction without cells
    for (const CutFacet& f : room->cut.facets())
      for (int d = 0; d < 3; ++d)
        if (!room->lattice.active(d)) EXPECT_EQ(f.area[d], 0);
}

TEST(CutCells, FacesAndFacetsCloseEveryCell) {
  const Room room(sphere({0.47, 0.52, 0.55}, 0.31, 6), {16, 16, 16});
  double moment = 0;
  for (const CutVolume& c : room.cut.cells()) {
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(c.open[d][1] - c.open[d][0] + c.area[d], 0, 1e-12);
      EXPECT_GE(c.centroid[d], 0);
      EXPECT_LE(c.centroid[d], 1);
      Index3 up = c.cell;
      ++up[size_t(d)];
      const CutVolume* other = room.cut.find(up);
      EXPECT_NEAR(c.open[d][1], other ? other->open[d][0] : double(room.cut.open(up)), 1e-12);
    }
    moment += c.volume * (c.cell[0] + c.centroid.x) / 16;
  }
  for (int n = 0; n < 16 * 16 * 16; ++n)
    if (const Index3 c{n % 16, n / 16 % 16, n / 256}; !room.cut.find(c) && room.cut.open(c))
      moment += (c[0] + 0.5) / 16;
  // first moment of the room without the ball, whose centroid is its centre
  EXPECT_NEAR(moment / 4096, 0.5 - (1 - room.volume()) * 0.47, 1e-12);
}

TEST(CutCells, OpenOrOverlappingWallsAreRefused) {
  coupling::WetSurface s = box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, 2);
  s.quads.pop_back();
  EXPECT_THROW(Room(s, {8, 8, 8}), PhysicsError);
  coupling::WetSurface a = box({0.2, 0.2, 0.2}, {0.6, 0.6, 0.6}), b = box({0.4, 0.4, 0.4}, {0.8, 0.8, 0.8});
  for (const auto& q : b.quads)
    a.quads.push_back({q[0] + int(a.x.size()), q[1] + int(a.x.size()), q[2] + int(a.x.size()), q[3] + int(a.x.size())});
  a.x.insert(a.x.end(), b.x.begin(), b.x.end());
  EXPECT_THROW(Room(a, {8, 8, 8}), PhysicsError);
}

/// A rigid body on its way, and the flow around it, step by step.
class Ride : public WallMotion {
 public:
  Ride(const std::string& text, coupling::WetSurface s, const Vec3& v, double spin)
      : cs(read_text(text)), m(world(), cs), s_(std::move(s)), X_(s_.x), v_(v), spin_(spin), books(m) {
    s_.v.assign(X_.size(), {});
    add_walls(m, 0);
    m.walls->begin(s_, s_.x, s_.v);
    paint(m, cs);
    std::vector<int> all(size_t(m.forest.local_blocks()));
    std::iota(all.begin(), all.end(), 0);
    books.refresh(m, all);
    sweep.emplace(m.forest, m.setup, &*m.walls);
    start = books.sums(m);
  }
  void steps(int n) {
    for (int i = 0; i < n; ++i) {
      s_.x = x();
      coupling::Loads loads;
      t_ += step(m, *sweep, books, cs.fluid.scheme.cfl / sweep->max_rate(m.state), this, true, &loads);
    }
  }
  const coupling::WetSurface& surface() const override { return s_; }
  std::vector<Vec3> x() const override { return at(t_); }
  std::vector<Vec3> velocity(double dt) const override {
    const std::vector<Vec3> now = at(t_);
    std::vector<Vec3> v = at(t_ + dt);
    for (size_t i = 0; i < v.size(); ++i) v[i] = (v[i] - now[i]) / dt;
    return v;
  }
  std::vector<Vec3> x_end(double dt) const override { return at(t_ + dt); }

  Case cs;
  Model m;

 private:
  std::vector<Vec3> at(double t) const {
    coupling::WetSurface s;
    s.x = X_;
    turn(s, spin_ * t, 0.5 * spin_ * t);
    for (Vec3& x : s.x) x += t * v_;
    return s.x;
  }
  coupling::WetSurface s_;
  std::vector<Vec3> X_;
  Vec3 v_;
  double spin_, t_ = 0;

 public:
  Books books;
  std::optional<Sweep> sweep;
  FluidSums start;
};

std::string gas_in_box(const std::string& boundary, const std::string& regions) {
  return "[fluid]\nlower = [0, 0, 0]\nupper = [1, 1, 1]\ncells = [16, 16, 16]\n" + boundary +
         "[fluid.walls]\ntreatment = \"cut_cell\"\n[[fluid.material]]\nname = \"air\"\neos = {kind = \"ideal_gas\", "
         "gamma = 1.4}\n"
         "[[fluid.region]]\nshape = {kind = \"everywhere\"}\nmaterial = \"air\"\ndensity = 1\npressure = 1\n" +
         regions;
}

TEST(CutCells, ABoxKeepsMassMomentumAndEnergyAroundABodyThatTurns) {
  coupling::WetSurface s = box({0.3, 0.3, 0.3}, {0.7, 0.6, 0.65}, 4);
  Ride ride(gas_in_box("",
                       "[[fluid.region]]\nshape = {kind = \"sphere\", centre = [0.1, 0.2, 0.3], radius = "
                       "0.25}\nmaterial = \"air\"\ndensity = 3\npressure = 5\n"),
            s, {0.3, -0.2, 0.1}, 2);
  ride.steps(30);
  const FluidSums end = ride.books.sums(ride.m);
  EXPECT_NEAR(end.U[Cons::arho1] / ride.start.U[Cons::arho1], 1, 1e-13);
  EXPECT_NEAR((end.U[Cons::rhoE] + ride.books.wall_energy) / ride.start.U[Cons::rhoE], 1, 1e-13);
  EXPECT_GT(std::abs(ride.books.wall_energy), 1e-3 * ride.start.U[Cons::rhoE]);
  EXPECT_NEAR(end.volume / ride.start.volume, 1, 1e-6);
  const Booked booked = ride.books.booked(ride.m);
  for (int d = 0; d < 3; ++d) {
    double sides = 0;
    for (int side = 0; side < 6; ++side) sides += (side % 2 ? 1 : -1) * booked.side[side][Cons::mom + d];
    EXPECT_NEAR(end.U[Cons::mom + d] + ride.books.wall_impulse[d] + sides, 0, 1e-13);
    EXPECT_NEAR(ride.books.wall_impulse[d], ride.books.face_impulse[d], 1e-12);
  }
}

TEST(CutCells, GasThatMovesWithABodyDoesNotFeelIt) {
  const std::string boundary =
      "boundary = {x_lower = \"periodic\", x_upper = \"periodic\", y_lower = \"periodic\", y_upper = \"periodic\", "
      "z_lower = "
      "\"periodic\", z_upper = \"periodic\"}\n";
  coupling::WetSurface s = box({0.3, 0.3, 0.3}, {0.7, 0.6, 0.65}, 4);
  turn(s, 0.4, 0.3);
  Ride ride(gas_in_box(boundary, "velocity = [0.7, 0.4, -0.3]\n"), s, {0.7, 0.4, -0.3}, 0);
  ride.steps(20);
  for (int b = 0; b < ride.m.forest.local_blocks(); ++b) {
    const std::vector<double> open = open_volumes(ride.m, b);
    for (size_t c = 0; c < open.size(); ++c) {
      if (open[c] == 0) continue;
      EXPECT_NEAR(ride.m.state.block(b, Cons::arho1)[c], 1, 1e-12);
      EXPECT_NEAR(ride.m.state.block(b, Cons::mom)[c], 0.7, 1e-12);
      EXPECT_NEAR(ride.m.state.block(b, Cons::rhoE)[c], 2.5 + 0.5 * 0.74, 1e-12);
    }
  }
}

}  // namespace
}  // namespace bw::cfd
