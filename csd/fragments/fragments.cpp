// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/fragments.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "common/parallel/loop.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

Field<ElemId, ElemId> pieces_by_nodes(const Mesh& mesh) {
  std::vector<int32_t> root(size_t(mesh.node_count()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int32_t n) {
    while (root[size_t(n)] != n) n = root[size_t(n)] = root[size_t(root[size_t(n)])];
    return n;
  };
  for (const auto& h : mesh.hex) {
    int32_t p = find(h[0]);
    for (size_t a = 1; a < 8; ++a) {
      const int32_t q = find(h[a]);
      if (p == q) continue;
      root[size_t(std::max(p, q))] = std::min(p, q);
      p = std::min(p, q);
    }
  }
  std::vector<ElemId> lowest(root.size());
  Field<ElemId, ElemId> piece(size_t(mesh.elem_count()));
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    ElemId& low = lowest[size_t(find(mesh.hex[e][0]))];
    if (!low.valid()) low = e;
    piece[e] = low;
  }
  return piece;
}

Fragments::Fragments(const Mesh& mesh, double t)
    : volume_(size_t(mesh.elem_count())), label_(size_t(mesh.elem_count()), -1) {
  parallel_for(mesh.elem_count(),
               [&](int64_t e) { volume_[ElemId(e)] = hex_volume(corners(mesh.hex[ElemId(e)], mesh.X)).volume; });
  relabel(mesh, t);
}

bool Fragments::relabel(const Mesh& mesh, double t) {
  const auto piece = pieces_by_nodes(mesh);
  struct Part {
    int32_t old;  // label before
    double volume = 0;
    int64_t gid = std::numeric_limits<int64_t>::max();  // lowest
  };
  std::vector<Part> parts;  // by lowest element
  Field<int32_t, ElemId> part_of(size_t(mesh.elem_count()));
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    if (piece[e] == e) part_of[e] = int32_t(parts.size()), parts.push_back({label_[e]});
    part_of[e] = part_of[piece[e]];
    Part& part = parts[size_t(part_of[e])];
    part.volume += volume_[e];
    part.gid = std::min(part.gid, mesh.elem_gid[e]);
  }
  if (parts.size() == known_.size()) return false;
  std::vector<const Part*> heir(known_.size(), nullptr);  // of each fragment so far
  std::vector<std::pair<int64_t, int32_t>> order;         // (lowest gid, part)
  for (size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    order.push_back({part.gid, int32_t(i)});
    if (part.old < 0) continue;
    const Part*& best = heir[size_t(part.old)];
    if (!best || part.volume > best->volume || (part.volume == best->volume && part.gid < best->gid)) best = &part;
  }
  std::sort(order.begin(), order.end());
  std::vector<int32_t> label(parts.size());
  const auto before = known_;
  for (const auto& [gid, i] : order) {
    const Part& part = parts[size_t(i)];
    if (part.old >= 0 && heir[size_t(part.old)] == &part) {
      label[size_t(i)] = part.old;
      continue;
    }
    label[size_t(i)] = int32_t(known_.size());
    known_.push_back({next_id_++, part.old < 0 ? -1 : before[size_t(part.old)].id, t});
  }
  for (int32_t e = 0; e < mesh.elem_count(); ++e) label_[ElemId(e)] = label[size_t(part_of[ElemId(e)])];
  return true;
}

}  // namespace bw::csd
