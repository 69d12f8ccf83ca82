// SPDX-License-Identifier: Apache-2.0
#include "csd/fracture/fracture.h"

#include <algorithm>
#include <queue>

#include "common/app/error.h"
#include "common/parallel/loop.h"
#include "csd/fracture/disconnect.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

Fracture::Fracture(const FractureInput& input, const Mesh& mesh)
    : input_(input),
      weight_(size_t(mesh.elem_count()), 1.0),
      opened_by_(size_t(mesh.elem_count()), 0),
      is_done_(size_t(mesh.elem_count()), 0),
      seen_step_(size_t(mesh.elem_count()), 0),
      done_step_(size_t(mesh.elem_count()), 0) {
  if (!input.is_weighted) return;
  parallel_for(mesh.elem_count(),
               [&](int64_t e) { weight_[ElemId(e)] = hex_volume(corners(mesh.hex[ElemId(e)], mesh.X)).volume; });
}

void Fracture::begin_step(const Mesh& mesh) {
  ++step_;
  waiting_ = 0;
  mean_.resize(size_t(mesh.node_count()));
  mean_step_.resize(size_t(mesh.node_count()), 0);
  near_step_.resize(size_t(mesh.node_count()), 0);
}

void Fracture::forget(NodeId n) {
  if (size_t(n.value) >= mean_.size()) {
    mean_.resize(size_t(n.value) + 1);
    mean_step_.resize(size_t(n.value) + 1, 0);
  }
  mean_step_[n] = 0;
}

double Fracture::average(const Topology& topology, std::span<const double> fail, NodeId n) const {
  double sum = 0, weight = 0;
  for (const ElemId e : topology.elements(n)) {
    sum += weight_[e] * fail[size_t(e.value)];
    weight += weight_[e];
  }
  return sum / weight;
}

double Fracture::nodal(const Topology& topology, std::span<const double> fail, NodeId n) {
  if (mean_step_[n] == step_) return mean_[n];
  mean_step_[n] = step_;
  return mean_[n] = average(topology, fail, n);
}

double Fracture::selection(const Mesh& mesh, const Topology& topology, std::span<const double> fail, ElemId e) {
  if (!input_.is_smoothed) return fail[size_t(e.value)];
  double sum = 0;
  for (const NodeId n : mesh.hex[e]) sum += nodal(topology, fail, n);
  return sum / 8;
}

std::vector<ElemId> Fracture::broken_elements(const Mesh& mesh, const Topology& topology, std::span<const double> fail,
                                              const Holds& holds) {
  const auto shares_nothing = [&](ElemId e) {
    const auto& h = mesh.hex[e];
    return std::all_of(h.begin(), h.end(), [&](NodeId n) { return topology.elements(n).size() == 1; });
  };
  std::vector<ElemId> seen;
  const auto look = [&](ElemId e) {
    if (seen_step_[e] == step_) return;
    seen_step_[e] = step_;
    if (!is_done_[e] && opened_by_[e] < input_.faces_per_element && !(holds && holds(e))) seen.push_back(e);
  };
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId near(i);
    if (fail[size_t(i)] < 1 || is_done_[near]) continue;
    look(near);
    if (!input_.is_smoothed) continue;
    for (const NodeId n : mesh.hex[near]) {
      if (near_step_[n] == step_) continue;
      near_step_[n] = step_;
      for (const ElemId e : topology.elements(n)) look(e);
    }
  }
  if (input_.is_smoothed) average_nodes(mesh, topology, fail, seen);
  std::vector<char> is_broken(seen.size());
  parallel_for(int64_t(seen.size()), [&](int64_t i) {
    const ElemId e = seen[size_t(i)];
    if (shares_nothing(e))
      is_done_[e] = 1;
    else
      is_broken[size_t(i)] = selection(mesh, topology, fail, e) >= 1;
  });
  std::vector<ElemId> broken;
  for (size_t i = 0; i < seen.size(); ++i)
    if (is_broken[i]) broken.push_back(seen[i]);
  return broken;
}

/// Of the elements' nodes: selection() only reads them then.
void Fracture::average_nodes(const Mesh& mesh, const Topology& topology, std::span<const double> fail,
                             std::span<const ElemId> elems) {
  std::vector<NodeId> nodes;
  for (const ElemId e : elems)
    for (const NodeId n : mesh.hex[e])
      if (mean_step_[n] != step_) mean_step_[n] = step_, nodes.push_back(n);
  parallel_for(int64_t(nodes.size()), [&](int64_t i) {
    const NodeId n = nodes[size_t(i)];
    mean_[n] = average(topology, fail, n);
  });
}

std::vector<ElemId> Fracture::broken(const Mesh& mesh, const Topology& topology, std::span<const double> fail,
                                     const Holds& holds) {
  begin_step(mesh);
  std::vector<ElemId> list = broken_elements(mesh, topology, fail, holds);
  std::vector<std::pair<double, ElemId>> order;
  for (const ElemId e : list) order.push_back({selection(mesh, topology, fail, e), e});
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : mesh.elem_gid[a.second] < mesh.elem_gid[b.second];
  });
  for (size_t i = 0; i < list.size(); ++i) list[i] = order[i].second;
  return list;
}

bool Fracture::advance(Mesh& mesh, Topology& topology, std::span<const Vec3> x,
                       const std::function<Sym3(ElemId)>& sigma, std::span<const double> fail,
                       std::vector<NodeSplit>& splits, std::vector<ElemId>& changed, const Holds& holds) {
  const size_t splits_before = splits.size();
  const int64_t elems = mesh.elem_count();
  BW_CHECK(int64_t(x.size()) <= mesh.node_count() && int64_t(fail.size()) == elems);
  // a smoothed value is a mean of raw ones, so it reaches 1 only in the one-ring of an element that does
  if (parallel_max(elems, 0.0, [&](int64_t e) { return fail[size_t(e)]; }) < 1) {
    waiting_ = 0;
    return false;
  }
  begin_step(mesh);
  struct Candidate {
    double value;
    int64_t gid;
    ElemId elem;
    bool operator<(const Candidate& b) const { return value != b.value ? value < b.value : gid > b.gid; }
  };
  std::priority_queue<Candidate> worst;
  const auto consider = [&](ElemId e) {
    if (is_done_[e] || done_step_[e] == step_ || opened_by_[e] >= input_.faces_per_element || (holds && holds(e)))
      return;
    if (const double value = selection(mesh, topology, fail, e); value >= 1) worst.push({value, mesh.elem_gid[e], e});
  };
  // most of the broken elements wait: they are found in parallel and are done with, for within a step stresses stay and
  // faces only open
  const std::vector<ElemId> broken = broken_elements(mesh, topology, fail, holds);
  std::vector<char> can_open(broken.size());
  parallel_for(int64_t(broken.size()), [&](int64_t i) {
    const ElemId e = broken[size_t(i)];
    can_open[size_t(i)] = choose_face(mesh, topology, e, x, sigma(e)) >= 0;
  });
  for (size_t i = 0; i < broken.size(); ++i) {
    if (can_open[i]) {
      consider(broken[i]);
    } else {
      done_step_[broken[i]] = step_;
      ++waiting_;
    }
  }
  std::vector<ElemId> around;  // elements whose value an opened face changed
  while (!worst.empty()) {
    const auto [value, gid, e] = worst.top();
    worst.pop();
    if (done_step_[e] == step_ || selection(mesh, topology, fail, e) != value)
      continue;  // done, or listed again with its new value
    done_step_[e] = step_;
    const int side = choose_face(mesh, topology, e, x, sigma(e));
    if (side < 0) {
      ++waiting_;
      continue;
    }
    const size_t first = splits.size();
    if (detach_face(mesh, topology, {e, side}, splits, changed) == 0) continue;
    ++opened_;
    ++opened_by_[e];
    if (!input_.is_smoothed) continue;
    around.clear();
    for (size_t i = first; i < splits.size(); ++i)
      for (const NodeId n : {splits[i].parent, splits[i].child}) {
        forget(n);
        for (const ElemId owner : topology.elements(n)) around.push_back(owner);
      }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (const ElemId owner : around) consider(owner);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return splits.size() > splits_before;
}

}  // namespace bw::csd
