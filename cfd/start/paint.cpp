// SPDX-License-Identifier: Apache-2.0
#include "cfd/start/paint.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cfd/start/overlap.h"
#include "common/app/error.h"
#include "common/app/log.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

/// The domain's cells as seen from the profile's centre: volumes within a radius, distances to it.
class View {
 public:
  View(const Start& start, const BlockShape& shape) : start_(start), radial_(shape.radial()), shape_(shape) {
    sphere_ = start.profile.geometry == Geometry::spherical;
    across_[0] = start.axis == 0 ? 1 : 0, across_[1] = start.axis == 2 ? 1 : 2;
  }
  /// Volume of a box of the domain within radius R; along a radius the box is a shell.
  double within(const Vec3& lower, const Vec3& upper, double R) const {
    if (radial_) {
      const double end = std::min(R, upper.x);
      if (end <= lower.x) return 0;
      BlockShape shell = shape_;
      shell.h.x = end - lower.x;
      return shell.cell_volume(lower.x, 0);
    }
    const Vec3 a = lower - start_.centre, b = upper - start_.centre;
    if (sphere_) return box_in_ball(a, b, R);
    const double low[2] = {a[across_[0]], a[across_[1]]}, high[2] = {b[across_[0]], b[across_[1]]};
    return rectangle_in_disc(low, high, R) * (b[start_.axis] - a[start_.axis]);
  }
  Vec3 from_centre(const Vec3& x) const {
    if (radial_) return {x.x, 0, 0};
    Vec3 d = x - start_.centre;
    if (!sphere_) d[start_.axis] = 0;
    return d;
  }
  /// Least and largest distance from the centre (or axis) to a box.
  std::pair<double, double> distances(const Vec3& lower, const Vec3& upper) const {
    if (radial_) return {lower.x, upper.x};
    double least = 0, most = 0;
    for (int d = 0; d < 3; ++d) {
      if (!sphere_ && d == start_.axis) continue;
      const double a = lower[d] - start_.centre[d], b = upper[d] - start_.centre[d];
      const double gap = std::max({a, -b, 0.0}), far = std::max(std::abs(a), std::abs(b));
      least += gap * gap, most += far * far;
    }
    return {std::sqrt(least), std::sqrt(most)};
  }
  /// Mean direction of the radius over a box.
  Vec3 direction(const Vec3& lower, const Vec3& upper) const {
    if (radial_) return {1, 0, 0};
    constexpr int n = 4;
    Vec3 sum;
    for (int c = 0; c < n * n * n; ++c) {
      const double s[3] = {(c % n + 0.5) / n, (c / n % n + 0.5) / n, (c / (n * n) + 0.5) / n};
      Vec3 x = lower;
      for (int d = 0; d < 3; ++d) x[d] += s[d] * (upper[d] - lower[d]);
      const Vec3 r = from_centre(x);
      if (const double length = norm(r); length > 0) sum += (1.0 / (n * n * n * length)) * r;
    }
    return sum;
  }

 private:
  const Start& start_;
  bool radial_, sphere_;
  const BlockShape& shape_;
  int across_[2];
};

void check_fit(const Start& s, const Model& m) {
  const auto wrong = [&](const std::string& text) { return InputError(fmt::format("{}: {}", s.place, text)); };
  const GridSize& grid = m.forest.size();
  const BlockShape& shape = m.forest.shape();
  if (shape.radial()) {
    if (s.profile.geometry != shape.geometry)
      throw wrong("expected a profile of the geometry of this run: sphere to sphere, cylinder to cylinder");
    if (s.profile.r.front() > grid.lower.x)
      throw wrong(
          fmt::format("the profile begins at a radius of {:g} m, within this run's domain", s.profile.r.front()));
    if (s.reach > grid.upper.x)
      throw wrong(fmt::format("the profile reaches a radius of {:g} m, beyond fluid.radius", s.reach));
    return;
  }
  if (s.profile.r.front() > 0)
    throw wrong(
        fmt::format("expected a profile that begins at the centre, not at a radius of {:g} m", s.profile.r.front()));
  for (int d = 0; d < 3; ++d) {
    if (s.profile.geometry == Geometry::cylindrical && d == s.axis) continue;
    if (!shape.used[size_t(d)])
      throw wrong(fmt::format("a {} needs cells in {}",
                              s.profile.geometry == Geometry::spherical ? "sphere" : "cylinder", "xyz"[d]));
    for (int upper = 0; upper < 2; ++upper) {
      const double room = upper ? grid.upper[d] - s.centre[d] : s.centre[d] - grid.lower[d];
      const bool plane = std::abs(room) < 1e-9 * s.reach && m.setup.boundary.side[2 * d + upper].kind == SideKind::wall;
      if (!plane && room < s.reach * (1 - 1e-12))
        throw wrong(
            fmt::format("the profile reaches {:g} m from its centre, the side {}_{} of the domain is {:g} m away: "
                        "expected a larger domain, or a "
                        "wall (plane of symmetry) through the centre",
                        s.reach, "xyz"[d], upper ? "upper" : "lower", room));
    }
  }
}

/// Shells of the profile from `first` on and what each gives to one cell.
void paint_cell(const Start& s, int variables, const View& view, const Vec3& lower, const Vec3& upper,
                double cell_volume, double (&U)[Cons::most]) {
  const Profile& p = s.profile;
  const auto [least, most] = view.distances(lower, upper);
  if (least >= s.reach) return;
  const size_t shells = size_t(std::upper_bound(p.r.begin(), p.r.end(), s.reach * (1 - 1e-14)) - p.r.begin());
  size_t i = size_t(std::upper_bound(p.r.begin(), p.r.end(), least) - p.r.begin());
  i = i > 0 ? i - 1 : 0;
  double sum[Cons::most] = {}, inner = i == 0 ? 0 : view.within(lower, upper, p.r[i]);
  const double begin = inner;
  for (; i < shells && i < p.U.size() && (p.r[i] < most || inner == begin); ++i) {
    const double outer = view.within(lower, upper, p.r[i + 1]);
    for (int q = 0; q < variables; ++q) sum[s.row[q]] += (outer - inner) * p.U[i][size_t(q)];
    inner = outer;
  }
  const double covered = inner - begin;
  if (!(covered > 0)) return;
  if (s.swapped) sum[Cons::alpha1] = covered - sum[Cons::alpha1];
  const double radial = sum[Cons::mom];
  const Vec3 along = view.direction(lower, upper);
  for (int d = 0; d < 3; ++d) sum[Cons::mom + d] = radial * along[d];
  const bool whole = most <= s.reach;  // round-off of the volumes must not leave traces of the regions
  for (int q = 0; q < variables; ++q)
    U[q] = whole ? sum[q] / covered : (U[q] * (cell_volume - covered) + sum[q]) / cell_volume;
  for (int q = Cons::alpha1; q < variables; ++q) {
    if (!Cons::is_alpha(q)) continue;
    if (std::abs(U[q] - 1) < 1e-13) U[q] = 1;
    if (std::abs(U[q]) < 1e-13) U[q] = 0;
  }
}

/// Rows of the profile's materials as rows of this run's, which has more than two; to[a]: where material a is here.
std::array<double, Cons::most> laid_out(const std::array<double, Cons::most>& from, const std::vector<int>& to) {
  std::array<double, Cons::most> U{};
  for (int q = Cons::mom; q <= Cons::rhoE; ++q) U[size_t(q)] = from[size_t(q)];
  for (size_t a = 0; a < to.size(); ++a) {
    const double first = from[Cons::alpha1];
    U[size_t(Cons::arho(to[a]))] = from[size_t(Cons::arho(int(a)))];
    U[size_t(Cons::alpha(to[a]))] = to.size() <= 2 && a == 1 ? 1 - first : from[size_t(Cons::alpha(int(a)))];
  }
  return U;
}

}  // namespace

Start begin_from(const StartCase& in, const Model& m) {
  Start s;
  s.place = in.place;
  s.profile = read_profile(in.file, in.place);
  s.centre = in.centre;
  s.axis = in.axis[0] - 'x';
  s.reach = s.profile.reach();
  for (int q = 0; q < Cons::most; ++q) s.row[q] = q;
  std::vector<int> to;
  const Medium& medium = m.setup.medium;
  const std::vector<double> mine = probe_materials(medium);
  const size_t each = mine.size() / size_t(medium.count());
  for (size_t a = 0; a < s.profile.materials.size(); ++a) {
    const auto found = std::find(medium.names.begin(), medium.names.end(), s.profile.materials[a]);
    if (found == medium.names.end())
      throw InputError(fmt::format("{}: {} holds {}, this case {}", in.place, in.file,
                                   fmt::join(s.profile.materials, " and "), fmt::join(medium.names, " and ")));
    const size_t b = size_t(found - medium.names.begin());
    to.push_back(int(b));
    if (medium.count() <= 2) s.row[a] = int(b);
    if (s.profile.materials.size() == 2 || a == 0) s.swapped = a == 0 ? b == 1 : s.swapped;
    for (size_t i = 0; i < each; ++i)
      if (std::abs(mine[b * each + i] - s.profile.probes.at(a * each + i)) > 1e-9 * std::abs(mine[b * each + i]))
        throw InputError(fmt::format("{}: \"{}\" has another equation of state in {} than in this case", in.place,
                                     s.profile.materials[a], in.file));
  }
  if (medium.count() > 2) {
    s.swapped = false;
    for (auto& U : s.profile.U) U = laid_out(U, to);
  }
  if (s.row[0] == s.row[1]) s.row[1] = 1 - s.row[0];  // one material: the other's row is zero
  check_fit(s, m);
  return s;
}

void paint_profile(Model& m, const Start& start, bool report) {
  const View view(start, m.forest.shape());
  parallel_for_dynamic(m.forest.local_blocks(), [&](int64_t block) {
    const int b = int(block);
    const BlockShape& s = m.forest.shape(b);
    const Vec3 corner = m.forest.lower(b);
    if (view.distances(corner, corner + m.forest.extent(b)).first >= start.reach) return;
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          const Vec3 lower = corner + Vec3{i * s.h.x, j * s.h.y, k * s.h.z};
          double U[Cons::most];
          const size_t cell = s.at(k, j, i);
          for (int q = 0; q < m.state.rows(); ++q) U[q] = m.state.block(b, q)[cell];
          paint_cell(start, m.state.rows(), view, lower, lower + s.h, s.cell_volume(corner.x, i), U);
          for (int q = 0; q < m.state.rows(); ++q) m.state.block(b, q)[cell] = U[q];
        }
  });
  if (report)
    say("{} of {:.6g} m at t = {:.6g} s from {}{}", start.profile.geometry == Geometry::spherical ? "ball" : "cylinder",
        start.reach, start.profile.t, start.profile.file,
        start.reach == start.profile.r.back() ? "; it had reached the end of that run's domain" : "");
}

}  // namespace bw::cfd
