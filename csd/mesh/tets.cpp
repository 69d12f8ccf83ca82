// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/tets.h"

#include <algorithm>

namespace bw::csd {

TetSplit::Key TetSplit::key(std::array<int32_t, 3> c) {
  if (c[2] < 0) {
    if (c[0] > c[1]) std::swap(c[0], c[1]);
  } else {
    std::sort(c.begin(), c.end());
  }
  return {uint64_t(uint32_t(c[0])) << 32 | uint32_t(c[1]), uint32_t(c[2])};
}

int32_t TetSplit::mean_node(std::array<int32_t, 4> c, int n) {
  Vec3 sum;
  std::sort(c.begin(), c.end(),
            [](int32_t a, int32_t b) { return uint32_t(a) < uint32_t(b); });  // one rounding for all; -1 last
  for (int i = 0; i < n; ++i) sum += x[size_t(c[size_t(i)])];
  x.push_back(sum / double(n));
  origin.push_back(c);
  return int32_t(x.size()) - 1;
}

int32_t TetSplit::middle(std::array<int32_t, 3> c, int n) {
  auto [it, is_new] = middle_.try_emplace(key(c), -1);
  if (is_new) it->second = mean_node({c[0], c[1], c[2], -1}, n);
  return it->second;
}

TetSplit::TetSplit(std::vector<Vec3> points, const std::vector<std::array<int32_t, 4>>& tets) : x(std::move(points)) {
  for (size_t i = 0; i < x.size(); ++i) origin.push_back({int32_t(i), -1, -1, -1});
  hexes.reserve(4 * tets.size());
  for (auto q : tets) {
    const auto at = [&](int i) { return x[size_t(q[size_t(i)])]; };
    if (triple(at(1) - at(0), at(2) - at(0), at(3) - at(0)) < 0) std::swap(q[2], q[3]);
    const int32_t centre = mean_node(q, 4);
    const auto edge = [&](int32_t a, int32_t b) { return middle({a, b, -1}, 2); };
    const auto face = [&](int32_t a, int32_t b, int32_t c) { return middle({a, b, c}, 3); };
    constexpr int order[4][4] = {
        {0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}};  // corner and the others, right-handed
    for (const auto& p : order) {
      const int32_t a = q[size_t(p[0])], b = q[size_t(p[1])], c = q[size_t(p[2])], d = q[size_t(p[3])];
      hexes.push_back({a, edge(a, b), face(a, b, c), edge(a, c), edge(a, d), face(a, b, d), centre, face(a, c, d)});
    }
  }
}

int32_t TetSplit::find(std::array<int32_t, 3> c) const {
  const auto it = middle_.find(key(c));
  return it == middle_.end() ? -1 : it->second;
}

std::array<std::array<int32_t, 4>, 3> TetSplit::quads_of(std::array<int32_t, 3> t) const {
  const int32_t centre = find(t), e01 = find({t[0], t[1], -1}), e12 = find({t[1], t[2], -1}),
                e20 = find({t[2], t[0], -1});
  return {{{t[0], e01, centre, e20}, {t[1], e12, centre, e01}, {t[2], e20, centre, e12}}};
}

}  // namespace bw::csd
