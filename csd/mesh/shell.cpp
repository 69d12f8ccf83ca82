// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/shell.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "csd/mesh/quads.h"

namespace bw::csd {

using std::numbers::pi;

namespace {

double distance(const ProfilePoint& a, const ProfilePoint& b) { return std::hypot(a.z - b.z, a.r - b.r); }
ProfilePoint between(const ProfilePoint& a, const ProfilePoint& b, double t) {
  return {a.z + t * (b.z - a.z), a.r + t * (b.r - a.r)};
}

/// The profile by arc length s of its middle line.
class MiddleLine {
 public:
  explicit MiddleLine(const Profile& profile) : profile_(profile) {
    for (size_t i = 0; i < profile.inner.size(); ++i) {
      const ProfilePoint middle = between(profile.inner[i], profile.outer[i], 0.5);
      s_.push_back(i == 0 ? 0 : s_.back() + distance(middle_.back(), middle));
      middle_.push_back(middle);
      widest_ = std::max(widest_, middle.r);
    }
  }
  double length() const { return s_.back(); }
  double widest() const { return widest_; }
  /// Point at t = 0 (inner) .. 1 (outer).
  ProfilePoint at(double s, double t) const {
    const size_t i =
        std::min(s_.size() - 1, size_t(std::max<long>(1, std::upper_bound(s_.begin(), s_.end(), s) - s_.begin())));
    const double f = s_[i] > s_[i - 1] ? (s - s_[i - 1]) / (s_[i] - s_[i - 1]) : 0;
    return between(between(profile_.inner[i - 1], profile_.inner[i], f),
                   between(profile_.outer[i - 1], profile_.outer[i], f), t);
  }
  /// Where the disc over the pole ends: at a corner if one lies about there, else where the body is 0.8 of its full
  /// width.
  double disc_end(bool at_upper) const {
    const size_t n = s_.size();
    const auto from_pole = [&](size_t i) { return at_upper ? length() - s_[n - 1 - i] : s_[i]; };
    const auto index = [&](size_t i) { return at_upper ? n - 1 - i : i; };
    size_t wide = 0;
    while (middle_[index(wide)].r < 0.8 * widest_) ++wide;
    for (size_t i = 1; i + 1 < n && from_pole(i) <= 1.6 * from_pole(wide); ++i)
      if (profile_.is_mark[index(i)] && middle_[index(i)].r >= 0.2 * widest_) return from_pole(i);
    return from_pole(wide);
  }
  /// Ring positions from s0 to s1, through the marks between them.
  std::vector<double> stations(double s0, double s1, double h) const {
    std::vector<double> ends{s0};
    for (size_t i = 0; i < s_.size(); ++i)
      if (profile_.is_mark[i] && s_[i] > s0 + 1e-9 * length() && s_[i] < s1 - 1e-9 * length()) ends.push_back(s_[i]);
    ends.push_back(s1);
    std::vector<double> s{s0};
    for (size_t k = 1; k < ends.size(); ++k) {
      const int n = std::max(1, int(std::lround((ends[k] - ends[k - 1]) / h)));
      for (int i = 1; i <= n; ++i) s.push_back(i == n ? ends[k] : ends[k - 1] + (ends[k] - ends[k - 1]) * i / n);
    }
    return s;
  }

 private:
  const Profile& profile_;
  std::vector<double> s_;
  std::vector<ProfilePoint> middle_;
  double widest_ = 0;
};

/// Closed quad surface: arc length and direction about the axis for each point, quads counter-clockwise from outside.
struct Skin {
  struct Point {
    double s, c, d;  // arc length, (cos, sin)
  };
  std::vector<Point> p;
  std::vector<std::array<int32_t, 4>> quad;
  void add_disc(const Quads& disc, double s_pole, double s_rim, bool is_upper) {
    const int32_t first = int32_t(p.size());
    for (const auto& q : disc.p) {
      const double rho = std::hypot(q.x, q.y);
      p.push_back({rho > 1 - 1e-12 ? s_rim : s_pole + rho * (s_rim - s_pole), rho > 0 ? q.x / rho : 1,
                   rho > 0 ? q.y / rho : 0});
    }
    for (auto q : disc.quad) {
      if (!is_upper) std::swap(q[1], q[3]);
      quad.push_back({first + q[0], first + q[1], first + q[2], first + q[3]});
    }
  }
};

constexpr double low_fraction = 0.6, high_fraction = 0.75;  // of a disc's radius that its core may reach to

Skin make_skin(const MiddleLine& line, const ShellCount& count) {
  const int n = count.around, core = n / 8;
  const double h = count.element_size > 0 ? count.element_size : 2 * pi * line.widest() / n;
  const double low = line.disc_end(false), high = line.length() - line.disc_end(true);
  // a core that nearly fills its disc has flat corners, a small one narrow elements around it
  const auto disc = [&](double reach) {
    const double middle = std::clamp(core * h / reach, low_fraction, high_fraction);
    return quad_disc(core, std::max(1, int(std::lround((1 - middle) * reach / h))), middle);
  };
  const Quads lower = disc(low), upper = disc(line.length() - high);
  Skin skin;
  skin.add_disc(lower, 0, low, false);
  int32_t ring = int32_t(skin.p.size()) - n;  // the rim comes last
  const auto stations = line.stations(low, std::max(high, low), h);
  const auto join = [&](int32_t from, int32_t to) {
    for (int32_t b = 0; b < n; ++b) skin.quad.push_back({from + b, from + (b + 1) % n, to + (b + 1) % n, to + b});
  };
  for (size_t k = 1; k + 1 < stations.size(); ++k) {
    const int32_t next = int32_t(skin.p.size());
    for (int32_t b = 0; b < n; ++b) {
      const auto& below = skin.p[size_t(ring + b)];
      skin.p.push_back({stations[k], below.c, below.d});
    }
    join(ring, next);
    ring = next;
  }
  skin.add_disc(upper, line.length(), high, true);
  join(ring, int32_t(skin.p.size()) - n);
  return skin;
}

}  // namespace

double revolved_volume(const std::vector<ProfilePoint>& p) {
  double volume = 0;
  for (size_t i = 1; i < p.size(); ++i)
    volume += pi / 3 * (p[i].z - p[i - 1].z) * (p[i].r * p[i].r + p[i].r * p[i - 1].r + p[i - 1].r * p[i - 1].r);
  return volume;
}

Mesh loft(const Profile& profile, const ShellCount& count) {
  const MiddleLine line(profile);
  const Skin skin = make_skin(line, count);
  Quads q;
  q.p.resize(skin.p.size());
  q.quad = skin.quad;
  const auto place = [&](int i, int l) {
    const auto& p = skin.p[size_t(i)];
    const ProfilePoint at = line.at(p.s, double(l) / count.through);
    return Vec3{at.r * p.c, at.r * p.d, at.z};
  };
  Swept s = sweep(q, count.through, place, count.is_split);
  s.add_set("inner", [&](int, int l) { return l == 0; });
  s.add_set("outer", [&](int, int l) { return l == count.through; });
  return std::move(s.mesh);
}

Mesh ShellOfRevolution::make() const {
  const Profile profile = std::visit([](const auto& p) { return p.make(); }, shape);
  Mesh mesh = loft(profile, count);
  for (Vec3& x : mesh.X) x = along_axis(axis, base, x);
  return mesh;
}

}  // namespace bw::csd
