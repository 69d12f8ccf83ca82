// SPDX-License-Identifier: Apache-2.0
#include "csd/load/conditions/tie.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/app/error.h"
#include "csd/load/sets.h"

namespace bw::csd {
namespace {

struct Foot {
  double distance = 1e300;
  double N[4];
};

/// The point of a bilinear quad nearest to x: Newton on the parameters, kept on the quad.
Foot nearest_point(const std::array<Vec3, 4>& q, const Vec3& x) {
  double s = 0, t = 0;
  Foot foot;
  for (int i = 0; i < 20; ++i) {
    const double N[4] = {0.25 * (1 - s) * (1 - t), 0.25 * (1 + s) * (1 - t), 0.25 * (1 + s) * (1 + t),
                         0.25 * (1 - s) * (1 + t)};
    const Vec3 r = x - (N[0] * q[0] + N[1] * q[1] + N[2] * q[2] + N[3] * q[3]);
    if (norm(r) < foot.distance) foot.distance = norm(r), std::copy_n(N, 4, foot.N);
    const Vec3 ds = 0.25 * ((1 - t) * (q[1] - q[0]) + (1 + t) * (q[2] - q[3]));
    const Vec3 dt = 0.25 * ((1 - s) * (q[3] - q[0]) + (1 + s) * (q[2] - q[1]));
    const double ss = dot(ds, ds), st = dot(ds, dt), tt = dot(dt, dt), det = ss * tt - st * st;
    if (!(det > 0)) break;
    s = std::clamp(s + (tt * dot(ds, r) - st * dot(dt, r)) / det, -1.0, 1.0);
    t = std::clamp(t + (ss * dot(dt, r) - st * dot(ds, r)) / det, -1.0, 1.0);
  }
  return foot;
}

/// Faces by the cells of a grid that their boxes touch.
class FaceGrid {
 public:
  FaceGrid(const Mesh& mesh, const std::vector<Face>& faces) : mesh_(mesh), faces_(faces) {
    for (Face f : faces) {
      const auto q = corners_of(f);
      size_ = std::max({size_, norm(q[2] - q[0]), norm(q[3] - q[1])});
    }
    for (size_t i = 0; i < faces.size(); ++i) {
      const auto q = corners_of(faces[i]);
      Vec3 low = q[0], high = q[0];
      for (const Vec3& x : q)
        for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
      const auto a = cell(low), b = cell(high);
      for (int i0 = a[0] - 1; i0 <= b[0] + 1; ++i0)
        for (int i1 = a[1] - 1; i1 <= b[1] + 1; ++i1)
          for (int i2 = a[2] - 1; i2 <= b[2] + 1; ++i2) cells_[{i0, i1, i2}].push_back(i);
    }
  }
  double size() const { return size_; }
  /// The nearest face (the first of equals) within a cell's size.
  std::pair<Face, Foot> nearest(const Vec3& x) const {
    std::pair<Face, Foot> best;
    if (const auto it = cells_.find(cell(x)); it != cells_.end())
      for (const size_t i : it->second)
        if (const Foot foot = nearest_point(corners_of(faces_[i]), x); foot.distance < best.second.distance)
          best = {faces_[i], foot};
    return best;
  }

 private:
  std::array<Vec3, 4> corners_of(Face f) const {
    const auto n = mesh_.nodes_of(f);
    return {mesh_.X[n[0]], mesh_.X[n[1]], mesh_.X[n[2]], mesh_.X[n[3]]};
  }
  std::array<int, 3> cell(const Vec3& x) const {
    return {int(std::floor(x.x / size_)), int(std::floor(x.y / size_)), int(std::floor(x.z / size_))};
  }
  const Mesh& mesh_;
  const std::vector<Face>& faces_;
  double size_ = 1e-300;
  std::map<std::array<int, 3>, std::vector<size_t>> cells_;
};

}  // namespace

void Tie::select(const Mesh& mesh) {
  const std::vector<Face> leaders = face_sets(mesh, faces, place_faces);
  const FaceGrid grid(mesh, leaders);
  const double reach = tolerance > 0 ? tolerance : 0.01 * grid.size();
  std::vector<char> leads(size_t(mesh.node_count()), 0);
  for (Face f : leaders)
    for (NodeId n : mesh.nodes_of(f)) leads[size_t(n)] = 1;
  std::vector<NodeId> all;
  std::vector<int32_t> number(size_t(mesh.node_count()), -1);
  const auto index = [&](NodeId n) {
    if (number[size_t(n)] < 0) number[size_t(n)] = int32_t(all.size()), all.push_back(n);
    return number[size_t(n)];
  };
  ties_.clear();
  for (NodeId n : node_set(mesh, nodes, place)) {
    if (leads[size_t(n)]) continue;
    const auto [face, foot] = grid.nearest(mesh.X[n]);
    if (foot.distance > reach) continue;
    Point p{index(n), {}, {}};
    const auto corners = mesh.nodes_of(face);
    for (size_t a = 0; a < 4; ++a) p.corner[a] = index(corners[a]), p.N[a] = foot.N[a];
    ties_.push_back(p);
  }
  if (ties_.empty())
    throw InputError(fmt::format("{}: no node of \"{}\" lies within {:.3g} m of the faces", place, nodes, reach));
  reaction.renew(all, size_t(mesh.node_count()));
}

void Tie::on_force(State& s, double dt) {
  const auto& n = reaction.nodes;
  force_.resize(n.size()), mass_.resize(n.size());
  for (size_t i = 0; i < n.size(); ++i) force_[i] = s.f[n[i]], mass_[i] = s.m[n[i]];
  for (const Point& p : ties_)
    for (int a = 0; a < 4; ++a) {
      force_[size_t(p.corner[a])] += p.N[a] * s.f[n[size_t(p.follower)]];
      mass_[size_t(p.corner[a])] += p.N[a] * s.m[n[size_t(p.follower)]];
    }
  for (size_t i = 0; i < n.size(); ++i) force_[i] = (1 / mass_[i]) * force_[i];  // accelerations
  for (const Point& p : ties_) {
    Vec3 a_follower;
    for (int a = 0; a < 4; ++a) a_follower += p.N[a] * force_[size_t(p.corner[a])];
    force_[size_t(p.follower)] = a_follower;
  }
  for (size_t i = 0; i < n.size(); ++i) reaction.take_force(s, i, s.f[n[i]] - s.m[n[i]] * force_[i], dt);
}

void Tie::follow(State& s) {
  for (const Point& p : ties_) {
    Vec3 v;
    for (int a = 0; a < 4; ++a) v += p.N[a] * s.v[reaction.nodes[size_t(p.corner[a])]];
    reaction.set_velocity(s, reaction.nodes[size_t(p.follower)], v);
  }
}

}  // namespace bw::csd
