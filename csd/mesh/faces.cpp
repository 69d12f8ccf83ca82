// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/faces.h"

#include <algorithm>
#include <unordered_map>

#include "common/app/error.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

Field<std::array<int32_t, 6>, ElemId> pair_faces(const Mesh& mesh, const std::string& where) {
  // faces in buckets by their lowest node: a bucket holds a handful
  const int32_t faces = mesh.elem_count() * 6;
  std::vector<int32_t> start(size_t(mesh.node_count()) + 1, 0), bucket(static_cast<size_t>(faces));
  const auto lowest = [&](int32_t code) {
    const auto n = mesh.nodes_of(face_of(code));
    return std::min(std::min<int32_t>(n[0], n[1]), std::min<int32_t>(n[2], n[3]));
  };
  for (int32_t code = 0; code < faces; ++code) ++start[size_t(lowest(code)) + 1];
  for (size_t n = 1; n < start.size(); ++n) start[n] += start[n - 1];
  std::vector<int32_t> next(start.begin(), start.end() - 1);
  for (int32_t code = 0; code < faces; ++code) bucket[size_t(next[size_t(lowest(code))]++)] = code;

  const auto sorted = [&](int32_t code) {
    auto n = mesh.nodes_of(face_of(code));
    std::sort(n.begin(), n.end());
    return n;
  };
  Field<std::array<int32_t, 6>, ElemId> partner(size_t(mesh.elem_count()), {-1, -1, -1, -1, -1, -1});
  for (size_t n = 0; n + 1 < start.size(); ++n) {
    for (int32_t i = start[n]; i < start[n + 1]; ++i) {
      const int32_t a = bucket[size_t(i)];
      const auto nodes = sorted(a);
      for (int32_t j = i + 1; j < start[n + 1]; ++j) {
        const int32_t b = bucket[size_t(j)];
        if (sorted(b) != nodes) continue;
        const Face fa = face_of(a), fb = face_of(b);
        int32_t &pa = partner[fa.elem][size_t(fa.side)], &pb = partner[fb.elem][size_t(fb.side)];
        if (pa >= 0 || pb >= 0)
          throw InputError(where + ": three elements share one face, two of them " +
                           std::to_string(mesh.elem_gid[fa.elem]) + " and " + std::to_string(mesh.elem_gid[fb.elem]) +
                           " (elements overlap)");
        pa = b;
        pb = a;
      }
    }
  }
  return partner;
}

std::vector<Face> boundary_faces(const Mesh& mesh, const std::string& where) {
  const auto partner = pair_faces(mesh, where);
  std::vector<Face> faces;
  for (int32_t e = 0; e < mesh.elem_count(); ++e)
    for (int s = 0; s < 6; ++s)
      if (partner[ElemId(e)][size_t(s)] < 0) faces.push_back({ElemId(e), s});
  return faces;
}

void add_set(Mesh& mesh, const std::vector<Face>& boundary, const std::string& name,
             const std::function<bool(NodeId)>& holds) {
  auto& nodes = mesh.node_sets[name];
  for (int32_t n = 0; n < mesh.node_count(); ++n)
    if (holds(NodeId(n))) nodes.push_back(NodeId(n));
  auto& faces = mesh.face_sets[name];
  for (const Face f : boundary) {
    const auto q = mesh.nodes_of(f);
    if (std::all_of(q.begin(), q.end(), holds)) faces.push_back(f);
  }
}

std::vector<NodeId> nodes_of_faces(const Mesh& mesh, const std::vector<Face>& faces) {
  std::vector<NodeId> nodes;
  for (const Face f : faces)
    for (const NodeId n : mesh.nodes_of(f)) nodes.push_back(n);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

FaceSum sum_faces(const Mesh& mesh, const Field<Vec3, NodeId>& x, const std::vector<Face>& faces) {
  FaceSum sum;
  for (const Face f : faces) {
    const auto q = mesh.nodes_of(f);
    const Vec3 area = 0.5 * cross(x[q[2]] - x[q[0]], x[q[3]] - x[q[1]]);
    sum.area += area;
    sum.area_norm += norm(area);
    sum.volume += cone_volume(x[q[0]], x[q[1]], x[q[2]], x[q[3]]);
  }
  return sum;
}

bool is_closed(const Mesh& mesh, const std::vector<Face>& faces) {
  std::unordered_map<uint64_t, int> count;  // (from, to), from < to -> runs up minus runs down; and how many in all
  std::unordered_map<uint64_t, int> total;
  for (const Face f : faces) {
    const auto q = mesh.nodes_of(f);
    for (size_t i = 0; i < 4; ++i) {
      const uint64_t a = uint64_t(q[i].value), b = uint64_t(q[(i + 1) % 4].value);
      const uint64_t key = std::min(a, b) << 32 | std::max(a, b);
      count[key] += a < b ? 1 : -1;
      ++total[key];
    }
  }
  const bool is_balanced = std::all_of(count.begin(), count.end(), [](const auto& c) { return c.second == 0; });
  return is_balanced && std::all_of(total.begin(), total.end(), [](const auto& c) { return c.second % 2 == 0; });
}

}  // namespace bw::csd
