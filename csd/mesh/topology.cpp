// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "common/app/error.h"
#include "csd/mesh/star.h"

namespace bw::csd {

Topology::Topology(const Mesh& mesh, const std::string& where)
    : partner_(pair_faces(mesh, where)), bonds_(size_t(mesh.elem_count()), 0), star_(size_t(mesh.node_count())) {
  for (const auto& h : mesh.hex)
    for (const NodeId n : h) ++star_[n].count;
  int32_t first = 0;
  for (Star& s : star_) {
    s.first = first;
    first += s.count;
    s.count = 0;
  }
  pool_.resize(size_t(first));
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    for (const NodeId n : mesh.hex[e]) pool_[size_t(star_[n].first + star_[n].count++)] = e;
    for (int side = 0; side < 6; ++side) {
      if (partner_[e][size_t(side)] >= 0)
        bonds_[e] = uint8_t(bonds_[e] | 1 << side);
      else
        boundary_.push_back({e, side});
    }
  }
  original_ = int(boundary_.size());
  memberships_.resize(1);
  membership_.resize(size_t(mesh.node_count()), 0);
  std::map<std::pair<int32_t, std::string>, int32_t> grown;  // (membership, one set more) -> membership
  for (const auto& [name, nodes] : mesh.node_sets)
    for (const NodeId n : nodes) {
      const auto [it, is_new] = grown.try_emplace({membership_[n], name}, int32_t(memberships_.size()));
      if (is_new) {
        memberships_.push_back(memberships_[size_t(membership_[n])]);
        memberships_.back().push_back(name);
      }
      membership_[n] = it->second;
    }
}

int Topology::star_parts(const Mesh& mesh, NodeId n, std::vector<int>& part) const {
  return csd::star_parts(*this, mesh, n, part, [](ElemId, ElemId) { return true; });
}

int Topology::star_parts(const Mesh& mesh, NodeId n) const {
  std::vector<int> part;
  return star_parts(mesh, n, part);
}

NodeId Topology::split(Mesh& mesh, NodeId parent, std::span<const ElemId> elems) {
  const std::vector<ElemId> moved(elems.begin(), elems.end());  // the span may look into pool_
  BW_CHECK(!moved.empty() && int32_t(moved.size()) < star_[parent].count);
  const NodeId child(mesh.node_count());
  mesh.X.push_back(mesh.X[parent]);
  mesh.node_gid.push_back(child.value);  // gids are dense, so the next one is the count
  mesh.parent.push_back(parent);
  membership_.push_back(membership_[parent]);
  for (const std::string& name : memberships_[size_t(membership_[parent])]) mesh.node_sets[name].push_back(child);
  Star& old = star_[parent];
  const auto begin = pool_.begin() + old.first, end = begin + old.count;
  const auto is_kept = [&](ElemId e) { return !std::binary_search(moved.begin(), moved.end(), e); };
  const auto middle = std::stable_partition(begin, end, is_kept);
  BW_CHECK(end - middle == long(moved.size()));
  star_.push_back({old.first + int32_t(middle - begin), int32_t(moved.size())});
  star_[parent].count -= int32_t(moved.size());
  for (const ElemId e : moved) {
    auto& h = mesh.hex[e];
    *std::find(h.begin(), h.end(), parent) = child;
  }
  for (const ElemId e : moved) renew_bonds(mesh, e);
  ++version_;
  return child;
}

void Topology::renew_bonds(const Mesh& mesh, ElemId e) {
  for (int side = 0; side < 6; ++side) {
    const Face f{e, side};
    if (!is_bonded(f)) continue;
    const Face g = partner(f);
    auto a = mesh.nodes_of(f), b = mesh.nodes_of(g);
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    if (a == b) continue;
    for (const Face h : {f, g}) {
      bonds_[h.elem] = uint8_t(bonds_[h.elem] & ~(1 << h.side));
      boundary_.push_back(h);
    }
  }
}

std::string Topology::find_fault(const Mesh& mesh) const {
  std::vector<int> uses(size_t(mesh.node_count()), 0);
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    auto h = mesh.hex[e];
    for (const NodeId n : h) {
      ++uses[size_t(n.value)];
      const auto star = elements(n);
      if (!std::binary_search(star.begin(), star.end(), e))
        return fmt::format("element {} is missing at its node {}", i, n.value);
    }
    std::sort(h.begin(), h.end());
    if (std::adjacent_find(h.begin(), h.end()) != h.end()) return fmt::format("element {} has a node twice", i);
    for (int side = 0; side < 6; ++side) {
      const Face f{e, side}, g = partner(f);
      if (!g.elem.valid()) continue;
      if (!(partner(g) == f)) return fmt::format("partner of face {} of element {} is not symmetric", side, i);
      auto a = mesh.nodes_of(f), b = mesh.nodes_of(g);
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      if ((a == b) != is_bonded(f) || is_bonded(f) != is_bonded(g))
        return fmt::format("bond of face {} of element {} is wrong", side, i);
    }
  }
  for (int32_t n = 0; n < mesh.node_count(); ++n) {
    const auto star = elements(NodeId(n));
    if (int(star.size()) != uses[size_t(n)] || !std::is_sorted(star.begin(), star.end()))
      return fmt::format("node {} lists {} elements, {} use it", n, star.size(), uses[size_t(n)]);
    if (star_parts(mesh, NodeId(n)) != 1)
      return fmt::format("node {} is a hinge of {} parts", n, star_parts(mesh, NodeId(n)));
  }
  if (!is_closed(mesh, boundary_)) return "the boundary is not closed";
  return "";
}

}  // namespace bw::csd
