// SPDX-License-Identifier: Apache-2.0
// The profiles that shells of revolution are made from.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "csd/mesh/shell.h"

namespace bw::csd {

using std::numbers::pi;

namespace {

using Line = std::vector<ProfilePoint>;

std::vector<size_t> corners_of(const Line& p) {  // and both ends
  std::vector<size_t> corner{0};
  for (size_t i = 1; i + 1 < p.size(); ++i) {
    const double before = std::atan2(p[i].r - p[i - 1].r, p[i].z - p[i - 1].z),
                 after = std::atan2(p[i + 1].r - p[i].r, p[i + 1].z - p[i].z);
    if (std::abs(std::remainder(after - before, 2 * pi)) > 20 * pi / 180) corner.push_back(i);
  }
  corner.push_back(p.size() - 1);
  return corner;
}

// relative arc lengths of the points first..last
std::vector<double> lengths(const Line& p, size_t first, size_t last) {
  std::vector<double> s{0};
  for (size_t i = first + 1; i <= last; ++i)
    s.push_back(s.back() + std::hypot(p[i].z - p[i - 1].z, p[i].r - p[i - 1].r));
  const double total = s.back();
  for (double& v : s) v = total > 0 ? v / total : v;
  return s;
}

ProfilePoint at(const Line& p, size_t first, const std::vector<double>& s, double t) {
  const size_t i = std::clamp<size_t>(size_t(std::lower_bound(s.begin(), s.end(), t) - s.begin()), 1, s.size() - 1);
  const double f = s[i] > s[i - 1] ? (t - s[i - 1]) / (s[i] - s[i - 1]) : 0;
  const ProfilePoint &a = p[first + i - 1], &b = p[first + i];
  return {a.z + f * (b.z - a.z), a.r + f * (b.r - a.r)};
}

Profile match(const Line& inner, const Line& outer) {
  Profile profile;
  auto corner_in = corners_of(inner), corner_out = corners_of(outer);
  if (inner.size() == outer.size()) {
    profile = {inner, outer, std::vector<bool>(inner.size(), false)};
    for (const auto& corner : {corner_in, corner_out})
      for (const size_t i : corner) profile.is_mark[i] = true;
    return profile;
  }
  if (corner_in.size() != corner_out.size()) {  // no way to pair the corners
    corner_in = {0, inner.size() - 1};
    corner_out = {0, outer.size() - 1};
  }
  for (size_t k = 1; k < corner_in.size(); ++k) {
    const auto s_in = lengths(inner, corner_in[k - 1], corner_in[k]),
               s_out = lengths(outer, corner_out[k - 1], corner_out[k]);
    std::vector<double> all(s_in);
    all.insert(all.end(), s_out.begin(), s_out.end());
    std::sort(all.begin(), all.end());
    double last = k == 1 ? -1 : 0;  // the piece's first point is the last one of the piece before
    for (const double t : all) {
      if (t - last < 1e-12) continue;
      last = t;
      profile.inner.push_back(at(inner, corner_in[k - 1], s_in, t));
      profile.outer.push_back(at(outer, corner_out[k - 1], s_out, t));
      profile.is_mark.push_back(t == 0 || t == all.back());
    }
  }
  profile.inner.front().r = profile.outer.front().r = profile.inner.back().r = profile.outer.back().r = 0;
  return profile;
}

Line arc(double z, double r, double radius, double from, double to,
         int n) {  // angle from the z-normal plane, towards +z
  Line p;
  for (int i = 0; i <= n; ++i) {
    const double a = from + (to - from) * i / n;
    p.push_back({z + radius * std::sin(a), r + radius * std::cos(a)});
  }
  return p;
}

void append(Line& p, const Line& more) { p.insert(p.end(), more.begin(), more.end()); }

constexpr int smooth = 2000;  // pieces of a curved line: chords stay within 1e-6 of the radius

// tangent ogive from (z, radius) into a sphere that ends `length` farther, in pieces of equal length
Line blunted_ogive(double z, double radius, double length, double tip) {
  const double big = ((length - tip) * (length - tip) + radius * radius - tip * tip) / (2 * (radius - tip));
  const double z_tip = z + length - tip, angle = std::atan2(length - tip, big - radius);
  const double first = big * angle, second = tip * (pi / 2 - angle);
  const int n = std::max(1, int(std::lround(smooth * first / (first + second))));
  Line p = arc(z, radius - big, big, 0, angle, n);
  Line round = arc(z_tip, 0, tip, angle, pi / 2, std::max(1, smooth - n));
  round.back() = {z + length, 0};
  p.insert(p.end(), round.begin() + 1, round.end());
  p.front() = {z, radius};
  return p;
}

}  // namespace

Profile PointsProfile::make() const {
  Line inner, outer;
  for (size_t i = 0; i < inner_z.size(); ++i) inner.push_back({inner_z[i], inner_r[i]});
  for (size_t i = 0; i < outer_z.size(); ++i) outer.push_back({outer_z[i], outer_r[i]});
  return match(inner, outer);
}

Profile SphereProfile::make() const {
  const auto half_circle = [](double r) {
    Line p = arc(0, 0, r, -pi / 2, pi / 2, 2 * smooth);
    p.front().r = p.back().r = 0;
    return p;
  };
  Profile profile{half_circle(radius - wall), half_circle(radius), {}};
  profile.is_mark.assign(profile.inner.size(), false);
  return profile;
}

Profile CanProfile::make() const {
  const double r = radius - wall, top = length - upper_wall;
  return match({{lower_wall, 0}, {lower_wall, r}, {top, r}, {top, 0}},
               {{0, 0}, {0, radius}, {length, radius}, {length, 0}});
}

Profile CapsuleProfile::make() const {
  const auto line = [&](double r) {
    Line p = arc(radius, 0, r, -pi / 2, 0, smooth);
    append(p, arc(length - radius, 0, r, 0, pi / 2, smooth));
    p.front().r = p.back().r = 0;
    return p;
  };
  Profile profile{line(radius - wall), line(radius), {}};
  profile.is_mark.assign(profile.inner.size(), false);
  profile.is_mark[smooth] = profile.is_mark[smooth + 1] = true;
  return profile;
}

Profile Weapon::profile() const {
  const double radius = diameter / 2, tail = tail_diameter / 2, shoulder = length - nose_length;
  const double t = base_plug / tail_length,
               floor = tail - tail_wall + t * (radius - wall - tail + tail_wall);  // radius of the cavity's floor
  Line outer{{0, 0}, {0, tail}, {tail_length, radius}},
      inner{{base_plug, 0}, {base_plug, floor}, {tail_length, radius - wall}};
  append(outer, blunted_ogive(shoulder, radius, nose_length, nose_radius));
  append(inner, blunted_ogive(shoulder, radius - wall, nose_length - nose_plug, 0.5 * nose_radius));
  Profile profile{inner, outer, std::vector<bool>(inner.size(), false)};
  for (const size_t corner : {1, 2, 3}) profile.is_mark[corner] = true;
  return profile;
}

Mesh Weapon::make() const {
  const bool is_demo = size == "demo", is_paper = size == "paper";
  ShellCount count;
  count.around = around > 0 ? around : is_demo ? 56 : is_paper ? 136 : 232;
  count.through = through > 0 ? through : is_demo ? 2 : is_paper ? 3 : 4;
  count.is_split = is_split;
  Mesh mesh = loft(profile(), count);
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    double z = 0;
    for (const NodeId n : mesh.hex[e]) z += mesh.X[n].z / 8;
    mesh.elem_sets[z > length - nose_plug ? "nose_plug" : z < base_plug ? "base_plug" : "wall"].push_back(e);
  }
  return mesh;
}

}  // namespace bw::csd
