// SPDX-License-Identifier: Apache-2.0
#include "csd/load/loaded_faces.h"

#include <algorithm>
#include <cstdint>

#include "csd/mesh/faces.h"

namespace bw::csd {

LoadedFaces::LoadedFaces(const Mesh& mesh, std::vector<Face> faces) : faces_(std::move(faces)) {
  std::sort(faces_.begin(), faces_.end(), [](Face a, Face b) { return face_code(a) < face_code(b); });
  constexpr size_t group_size = 128;
  std::vector<uint64_t> used(size_t(mesh.node_count()), 0);  // colours of the groups at a node, a bit each
  for (size_t first = 0; first < faces_.size(); first += group_size) {
    const size_t last = std::min(first + group_size, faces_.size());
    uint64_t taken = 0;
    for (size_t i = first; i < last; ++i)
      for (const NodeId n : mesh.nodes_of(faces_[i])) taken |= used[size_t(n)];
    size_t colour = 0;
    while (colour < 63 && (taken >> colour & 1)) ++colour;
    // the last of them all is for groups that found none free: those run one by one
    const bool is_alone = colour == 63;
    if (is_alone) colour = std::max<size_t>(colours_.size(), 63);
    if (colours_.size() <= colour) colours_.resize(colour + 1);
    colours_[colour].push_back({first, last});
    if (is_alone) continue;
    for (size_t i = first; i < last; ++i)
      for (const NodeId n : mesh.nodes_of(faces_[i])) used[size_t(n)] |= uint64_t{1} << colour;
  }
}

std::vector<int32_t> LoadedFaces::leave(const Mesh& mesh, const std::vector<char>& is_left) {
  std::vector<int32_t> left;
  if (is_left.empty()) {
    left_.clear();
    return left;
  }
  left_.resize(faces_.size(), 0);
  for (const auto& groups : colours_)
    for (const auto& [first, last] : groups)
      for (size_t i = first; i < last; ++i) {
        const NodeId n = mesh.nodes_of(faces_[i])[0];
        const bool is_now = size_t(n) < is_left.size() && is_left[size_t(n)];
        if (is_now && !left_[i]) left.push_back(int32_t(i));
        left_[i] = is_now;
      }
  return left;
}

void LoadedFaces::fetch(const Mesh& mesh, Group group, const Field<Vec3, NodeId>& x,
                        const Field<Vec3, NodeId>& f) const {
  for (size_t i = group.first; i < group.second; ++i) {
    if (is_left(i)) continue;
    for (const NodeId n : mesh.nodes_of(faces_[i])) __builtin_prefetch(&x[n]), __builtin_prefetch(&f[n], 1);
  }
}

}  // namespace bw::csd
