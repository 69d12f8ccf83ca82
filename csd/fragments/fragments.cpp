// SPDX-License-Identifier: Apache-2.0
#include "csd/fragments/fragments.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "common/parallel/loop.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

namespace {

/// For each of the elements (ascending) the place of the first that it hangs together with by shared nodes.
std::vector<int32_t> first_joined(const Mesh& mesh, std::span<const ElemId> elems) {
  const auto root = std::make_unique_for_overwrite<int32_t[]>(size_t(mesh.node_count()));
  for (const ElemId e : elems)
    for (const NodeId n : mesh.hex[e]) root[size_t(n)] = n.value;
  const auto find = [&](int32_t n) {
    while (root[size_t(n)] != n) n = root[size_t(n)] = root[size_t(root[size_t(n)])];
    return n;
  };
  for (const ElemId e : elems) {
    const auto& h = mesh.hex[e];
    int32_t p = find(h[0].value);
    for (size_t a = 1; a < 8; ++a) {
      const int32_t q = find(h[a].value);
      if (p == q) continue;
      root[size_t(std::max(p, q))] = std::min(p, q);
      p = std::min(p, q);
    }
  }
  std::vector<int32_t> first(elems.size());
  for (size_t i = 0; i < elems.size(); ++i) first[i] = find(mesh.hex[elems[i]][0].value);
  for (const int32_t n : first) root[size_t(n)] = -1;
  for (size_t i = 0; i < elems.size(); ++i) {
    int32_t& at = root[size_t(first[i])];
    if (at < 0) at = int32_t(i);
    first[i] = at;
  }
  return first;
}

}  // namespace

Field<ElemId, ElemId> pieces_by_nodes(const Mesh& mesh) {
  std::vector<ElemId> all;
  for (int32_t e = 0; e < mesh.elem_count(); ++e) all.push_back(ElemId(e));
  Field<ElemId, ElemId> piece(all.size());
  const std::vector<int32_t> first = first_joined(mesh, all);
  for (const ElemId e : all) piece[e] = ElemId(first[size_t(e)]);
  return piece;
}

Fragments::Fragments(const Mesh& mesh, double t)
    : volume_(size_t(mesh.elem_count())), label_(size_t(mesh.elem_count()), -1) {
  parallel_for(mesh.elem_count(),
               [&](int64_t e) { volume_[ElemId(e)] = hex_volume(corners(mesh.hex[ElemId(e)], mesh.X)).volume; });
  relabel(mesh, t);
}

/// Those of fragments that have nodes younger than the last call; at first all.
std::vector<ElemId> Fragments::cut_elements(const Mesh& mesh) {
  std::vector<char> is_cut(known_.size(), 0);
  for (int32_t i = 0; i < mesh.elem_count() && !known_.empty(); ++i) {
    const auto& h = mesh.hex[ElemId(i)];
    if (*std::max_element(h.begin(), h.end()) >= NodeId(nodes_)) is_cut[size_t(label_[ElemId(i)])] = 1;
  }
  nodes_ = mesh.node_count();
  std::vector<ElemId> elems;
  for (int32_t i = 0; i < mesh.elem_count(); ++i)
    if (known_.empty() || is_cut[size_t(label_[ElemId(i)])]) elems.push_back(ElemId(i));
  return elems;
}

bool Fragments::relabel(const Mesh& mesh, double t) {
  const std::vector<ElemId> elems = cut_elements(mesh);
  const std::vector<int32_t> first = first_joined(mesh, elems);
  struct Part {
    int32_t old;  // label before
    double volume = 0;
    int64_t gid = std::numeric_limits<int64_t>::max();  // lowest
  };
  std::vector<Part> parts;  // by lowest element
  std::vector<int32_t> part_of(elems.size());
  for (size_t i = 0; i < elems.size(); ++i) {
    const ElemId e = elems[i];
    if (first[i] == int32_t(i)) part_of[i] = int32_t(parts.size()), parts.push_back({label_[e]});
    part_of[i] = part_of[size_t(first[i])];
    Part& part = parts[size_t(part_of[i])];
    part.volume += volume_[e];
    part.gid = std::min(part.gid, mesh.elem_gid[e]);
  }
  std::vector<const Part*> heir(known_.size(), nullptr);  // of each fragment that was cut
  for (const Part& part : parts) {
    if (part.old < 0) continue;
    const Part*& best = heir[size_t(part.old)];
    if (!best || part.volume > best->volume || (part.volume == best->volume && part.gid < best->gid)) best = &part;
  }
  std::vector<int32_t> label(parts.size());
  std::vector<std::pair<int64_t, int32_t>> order;  // (lowest gid, part) of those that broke off
  for (size_t i = 0; i < parts.size(); ++i) {
    label[i] = parts[i].old;
    if (parts[i].old < 0 || heir[size_t(parts[i].old)] != &parts[i]) order.push_back({parts[i].gid, int32_t(i)});
  }
  if (order.empty()) return false;
  std::sort(order.begin(), order.end());
  for (const auto& [gid, i] : order) {
    const int32_t old = parts[size_t(i)].old;
    label[size_t(i)] = int32_t(known_.size());
    known_.push_back({next_id_++, old < 0 ? -1 : known_[size_t(old)].id, t});
  }
  for (size_t i = 0; i < elems.size(); ++i) label_[elems[i]] = label[size_t(part_of[i])];
  return true;
}

}  // namespace bw::csd
