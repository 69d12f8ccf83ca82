// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/lips.h"

#include <algorithm>
#include <array>
#include <map>

#include "coupling/loads.h"

namespace bw::cfd {

void Lips::pair(const coupling::WetSurface& s) {
  for (size_t i = 0; i < s.node_parent.size(); ++i)
    if (s.node_parent[i] >= 0) parent_.emplace(s.node_id[i], s.node_parent[i]);
  auto root = [&](int64_t id) {
    for (auto it = parent_.find(id); it != parent_.end(); it = parent_.find(id)) id = it->second;
    return id;
  };
  twin_.assign(s.quads.size(), -1);
  std::map<std::array<int64_t, 4>, int32_t> alone;
  for (size_t f = 0; f < s.quads.size(); ++f) {
    if (s.flags.empty() || !(s.flags[f] & coupling::face_lip)) continue;
    std::array<int64_t, 4> key;
    for (size_t a = 0; a < 4; ++a) key[a] = root(s.node_id[size_t(s.quads[f][a])]);
    std::sort(key.begin(), key.end());
    const auto [other, first] = alone.emplace(key, int32_t(f));
    if (first) continue;
    twin_[f] = other->second;
    twin_[size_t(other->second)] = int32_t(f);
    alone.erase(other);
  }
}

double Lips::aperture(const coupling::WetSurface& s, int32_t face) const {
  const int32_t twin = size_t(face) < twin_.size() ? twin_[size_t(face)] : -1;
  const Vec3 area = coupling::area_vector(s.x, s.quads[size_t(face)]);
  const double size = norm(area);
  if (twin < 0 || size == 0) return apart;
  const Vec3 gap = coupling::face_mean(s.x, s.quads[size_t(twin)]) - coupling::face_mean(s.x, s.quads[size_t(face)]);
  // lips that slid past each other are open too
  const double normal = dot(gap, area) / size, slide = norm(gap - (normal / size) * area);
  return slide > 2 * std::sqrt(size) ? apart : normal;
}

}  // namespace bw::cfd
