// SPDX-License-Identifier: Apache-2.0
#include "cfd/sample.h"

#include <algorithm>
#include <cmath>

namespace bw::cfd {

Sampler::Place Sampler::place(const Model& m, int point, const Forest::Cell& cell) const {
  const BlockShape& s = m.forest.shape(cell.block);
  const Vec3 lower = m.forest.lower(cell.block);
  Place at;
  at.point = point;
  const int home[3] = {cell.i, cell.j, cell.k};
  for (int d = 0; d < 3; ++d) {
    at.home[d] = home[d];
    // in cells, from the centre of the home cell; round-off is no distance
    double off = s.used[size_t(d)] ? (points_[size_t(point)][d] - lower[d]) / s.h[d] - 0.5 - home[d] : 0;
    if (std::abs(off) < 1e-9) off = 0;
    at.step[d] = off > 0 ? 1 : off < 0 ? -1 : 0;
    at.share[d] = std::abs(off);
  }
  return at;
}

bool Sampler::fit(const Model& m) {
  if (version_ == m.forest.version()) return false;
  version_ = m.forest.version();
  std::vector<std::pair<int, Place>> found;
  for (size_t i = 0; i < points_.size(); ++i)
    if (const Forest::Cell cell = m.forest.find(points_[i]); cell.block >= 0)
      found.emplace_back(cell.block, place(m, int(i), cell));
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  groups_.clear();
  place_.clear();
  const BlockShape& s = m.forest.shape();
  for (const auto& [block, at] : found) {
    if (groups_.empty() || groups_.back().block != block) groups_.push_back({block, place_.size(), 0, false});
    for (int d = 0; d < 3; ++d) {
      const int other = at.home[d] + at.step[d];
      if (other < 0 || other >= s.n[size_t(d)]) groups_.back().ghosts = true;
    }
    place_.push_back(at);
    groups_.back().last = place_.size();
  }
  return true;
}

bool Sampler::needs_copies(const Model& m) {
  fit(m);
  return std::any_of(groups_.begin(), groups_.end(), [](const Group& g) { return g.ghosts; });
}

void Sampler::begin(const Model& m, const Group& group, Space& space) const {
  if (!group.ghosts) return;
  if (space.patch.pitch() == 0) space.patch = Patch(m.forest.shape(), m.setup.medium.count());
  const Gather gather(m.forest, m.state, m.setup.boundary, m.setup.medium);
  gather.fill(group.block, space.patch, space.ghosts, true);
}

bool Sampler::value(const Model& m, const Group& group, const Place& at, const Space& space, FlowAt& flow) const {
  const BlockShape& s = m.forest.shape();
  const bool walls = m.walls && m.forest.level(group.block) == m.forest.levels();
  const Index3 first = walls ? m.forest.first_finest(group.block) : Index3{0, 0, 0};
  const Index3 end = m.forest.cells_of_level(m.forest.levels());
  /// In the walls' map: ghosts behind a side of the domain are the cell there, or that of the other end.
  const auto in_map = [&](const int(&c)[3]) {
    Index3 cell;
    for (size_t d = 0; d < 3; ++d) {
      cell[d] = first[d] + c[d];
      cell[d] = m.forest.size().periodic[d] ? (cell[d] + end[d]) % end[d] : std::clamp(cell[d], 0, end[d] - 1);
    }
    return cell;
  };
  int step[3];
  double share[3];
  if (m.walls && !walls && m.walls->map().blocked(m.forest.first_finest(group.block))) return false;
  if (walls && m.walls->map().blocked(in_map(at.home))) return false;
  for (int d = 0; d < 3; ++d) {
    step[d] = at.step[d], share[d] = at.share[d];
    if (!walls || step[d] == 0) continue;
    int other[3] = {at.home[0], at.home[1], at.home[2]};
    other[d] += step[d];
    const Index3 a = in_map(at.home), b = in_map(other);
    if (m.walls->map().blocked(b) || (a != b && m.walls->map().is_cut(step[d] > 0 ? a : b, d)))
      step[d] = 0, share[d] = 0;
  }
  const int fractions = m.setup.medium.told_fractions();
  double total = 0;
  FlowAt sum;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int c[3];
    for (int d = 0; d < 3; ++d) {
      const bool other = corner >> d & 1;
      c[d] = at.home[d] + (other ? step[d] : 0);
      weight *= other ? share[d] : 1 - share[d];
    }
    if (weight == 0 || (walls && m.walls->map().blocked(in_map(c)))) continue;
    double W[Prim::most];
    if (group.ghosts) {
      for (int q = 0; q < Prim::rows(m.setup.medium.count()); ++q) W[q] = space.patch.row(q, c[2], c[1])[c[0]];
    } else {
      double U[Cons::most];
      for (int q = 0; q < m.state.rows(); ++q) U[q] = m.state.block(group.block, q)[s.at(c[2], c[1], c[0])];
      std::visit([&](const auto& pair) { pair.to_primitive(U, W, m.setup.medium.floors); }, m.setup.medium.mixture);
    }
    total += weight;
    double rho = W[Prim::arho1] + W[Prim::arho2];
    for (int k = 2; k < m.setup.medium.count(); ++k) rho += W[Prim::arho(k)];
    sum.rho += weight * rho, sum.p += weight * W[Prim::p];
    for (int d = 0; d < 3; ++d) sum.v[d] += weight * W[Prim::v + d];
    for (int k = 0; k < fractions; ++k) sum.alpha[k] += weight * W[Prim::alpha(k)];
  }
  flow = {sum.rho / total, sum.p / total, sum.v / total};
  for (int k = 0; k < fractions; ++k) flow.alpha[k] = sum.alpha[k] / total;
  return true;
}

}  // namespace bw::cfd
