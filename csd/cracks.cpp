// SPDX-License-Identifier: Apache-2.0
#include "csd/cracks.h"

#include <algorithm>

#include "common/app/error.h"
#include "common/app/log.h"
#include "common/parallel/loop.h"
#include "csd/element/results.h"
#include "csd/model.h"

namespace bw::csd {

Cracks::Cracks(const FractureInput& input, const Mesh& mesh, double t, const std::vector<FailureData>& materials)
    : failure_(input, mesh, materials), fracture_(input, mesh), fragments_(mesh, t) {
  if (input.pieces) pieces_.emplace(*input.pieces, mesh);
}

/// Returns whether any element is broken; then all ranks know all values.
bool Cracks::update_failure(const Model& m) {
  const Elements& el = m.physics.elements;
  const auto* sigma_m = m.physics.filter ? m.physics.filter->mean_stress() : nullptr;
  failure_.update(el, m.state, m.physics.resting, sigma_m);
  std::vector<double>& fail = failure_.values();
  const double worst = parallel_max(int64_t(fail.size()), 0.0,
                                    [&](int64_t e) { return el.blocks.is_own(ElemId(e)) ? fail[size_t(e)] : 0; });
  if ((el.ranks ? el.ranks->comm().max(worst) : worst) < 1) return false;
  if (el.ranks) el.ranks->complete(fail);
  return true;
}

/// [element] Those whose stress may be asked for in this step: broken, or next to one that is.
std::vector<char> Cracks::near_broken(const Model& m) const {
  std::vector<char> is_asked(fail().size(), 0);
  for (int32_t e = 0; e < m.mesh.elem_count(); ++e)
    if (fail()[size_t(e)] >= 1)
      for (NodeId n : m.mesh.hex[ElemId(e)])
        for (ElemId near : m.topology.elements(n)) is_asked[size_t(near)] = 1;
  return is_asked;
}

bool Cracks::advance(Model& m) {
  if (!update_failure(m)) return false;
  const auto* sigma_m = m.physics.filter ? m.physics.filter->mean_stress() : nullptr;
  const Elements& el = m.physics.elements;
  const auto own = [&](ElemId e) { return evaluate(el, m.state, el.blocks.slot[e], sigma_m).sigma; };
  std::vector<Sym3> of_all;  // several ranks: the same cracks on each
  if (el.ranks) {
    const std::vector<char> is_asked = near_broken(m);
    of_all = el.ranks->complete_some<Sym3>(is_asked, own);
    el.ranks->complete_positions(m.mesh, is_asked, m.state);
  }
  const auto sigma = [&](ElemId e) { return el.ranks ? of_all[size_t(e)] : own(e); };
  splits_.clear(), changed_.clear();
  Fracture::Holds holds;
  if (pieces_) {
    make_pieces(m);
    holds = [&](ElemId e) { return pieces_->holds(e); };
  }
  fracture_.advance(m.mesh, m.topology, {m.state.x.data(), m.state.x.size()}, sigma, fail(), splits_, changed_, holds);
  if (splits_.empty()) return false;
  take_over(m, splits_, changed_);
  return true;
}

void Cracks::make_pieces(Model& m) {
  const std::vector<ElemId> broken =
      fracture_.broken(m.mesh, m.topology, fail(), [&](ElemId e) { return !pieces_->is_free(e); });
  std::vector<ElemId> taken;
  opened_by_pieces_ += pieces_->advance(
      m.mesh, m.topology, m.state.t, broken, fail(),
      [&](std::span<const ElemId> elems) {
        if (m.physics.rigid && std::any_of(elems.begin(), elems.end(),
                                           [&](ElemId e) { return m.physics.rigid->is_rigid(m.mesh.hex[e][0]); }))
          m.physics.rigid->complete(m.state);
        return ring_samples(m, elems);
      },
      splits_, changed_, taken,
      [&](ElemId e) { return m.physics.rigid && m.physics.rigid->is_rigid(m.mesh.hex[e][0]); });
  if (taken.empty()) return;
  fracture_.retire(taken);
  const Row& row = pieces_->rows().back();
  if (warned_ || row.across >= 3) return;
  warned_ = true;
  warn("pieces of a width of {:.3g} mm span {:.2g} elements of the mesh: sizes come out right from 3 on (t = {:.6g} s)",
       1e3 * row.width, row.across, row.t);
}

/// The same on all ranks.
std::vector<RingSample> Cracks::ring_samples(const Model& m, std::span<const ElemId> elems) const {
  const Elements& el = m.physics.elements;
  const State& s = m.state;
  const AxisFrame& frame = pieces_->frame();
  const auto sample = [&](ElemId e) {
    const SlotId slot = el.blocks.slot[e];
    RingSample r;
    for (NodeId n : m.mesh.hex[e]) {
      while (size_t(n) >= s.x.size()) n = m.mesh.parent[n];  // split off in this step: at its parent's place
      const Vec3 away = frame.away(s.x[n]);
      const double radius = norm(away);
      r.radius += 0.125 * radius;
      if (radius > 0) r.speed += 0.125 * dot(s.v[n], away) / radius;
    }
    r.density = density(el, slot);
    r.mass = r.density * s.V0[slot];
    constexpr double plane_strain = 1.1547005383792515;  // 2/sqrt(3): a long case doesn't change its length
    r.stress = flow_stress(el, s, slot, plane_strain * r.speed / r.radius);
    return r;
  };
  std::vector<RingSample> samples(elems.size());
  if (el.ranks) {
    std::vector<char> is_asked(fail().size(), 0);
    for (const ElemId e : elems) is_asked[size_t(e)] = 1;
    const auto all = el.ranks->complete_some<RingSample>(is_asked, sample);
    for (size_t i = 0; i < elems.size(); ++i) samples[i] = all[size_t(elems[i])];
  } else {
    parallel_for(int64_t(elems.size()), [&](int64_t i) { samples[size_t(i)] = sample(elems[size_t(i)]); });
  }
  return samples;
}

void Cracks::repeat(Model& m, std::span<const std::array<NodeId, 8>> hex, std::span<const NodeId> parent) {
  std::vector<NodeSplit> splits;
  std::vector<ElemId> changed;
  for (NodeId child(m.mesh.node_count()); size_t(child) < parent.size(); child = NodeId(m.mesh.node_count())) {
    const NodeId from = parent[size_t(child)];
    std::vector<ElemId> moved;  // whose corner is the child in the end, or was split from it later
    for (const ElemId e : m.topology.elements(from)) {
      const auto& now = m.mesh.hex[e];
      NodeId last = hex[size_t(e)][size_t(std::find(now.begin(), now.end(), from) - now.begin())];
      while (last > child) last = parent[size_t(last)];
      if (last == child) moved.push_back(e);
    }
    if (moved.empty() || moved.size() == m.topology.elements(from).size())
      throw InputError("the checkpoint doesn't fit the case's mesh: it has a crack that can't be");
    splits.push_back({from, m.topology.split(m.mesh, from, moved)});
    changed.insert(changed.end(), moved.begin(), moved.end());
  }
  grow(m, splits, changed);
}

/// Whatever follows the mesh.
void Cracks::grow(Model& m, const std::vector<NodeSplit>& splits, const std::vector<ElemId>& changed) {
  auto& [mesh, topology, s, ph] = m;
  s.append_copies(splits);
  if (ph.elements.ranks)
    ph.elements.ranks->append_copies(splits, s);
  else if (!s.followed.empty())
    for (const NodeSplit& split : splits) s.followed.push_back(split.child);
  if (ph.loads) ph.loads->append_copies(splits);
  for (ElemId e : changed) ph.elements.blocks.renew(mesh, e);
  for (auto& kind : ph.conditions) std::visit([&mesh = mesh](auto& c) { c.select(mesh); }, kind);
  if (ph.relaxation) ph.relaxation->select(s.x.size());
}

void Cracks::take_over(Model& m, const std::vector<NodeSplit>& splits, const std::vector<ElemId>& changed) {
  grow(m, splits, changed);
  auto& [mesh, topology, s, ph] = m;
  std::vector<NodeId> touched;
  for (const NodeSplit& split : splits) touched.push_back(split.parent), touched.push_back(split.child);
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  // children of children hold copies of the first parent's mass: all see the mass before the step
  parallel_for(int64_t(touched.size()), [&, &mesh = mesh, &topology = topology, &s = s, &ph = ph](int64_t i) {
    const NodeId n = touched[size_t(i)];
    const double before = s.m[n];
    s.m[n] = node_mass(mesh, ph.elements, topology.elements(n), n);
    s.f[n] = (s.m[n] / before) * s.f[n];
    if (ph.loads) ph.loads->forces()[n] = (s.m[n] / before) * ph.loads->forces()[n];
  });
  ph.time_step.renew(mesh, topology, ph.elements, s, touched);
  if (ph.filter) ph.energy.cracks += ph.filter->open(mesh, topology, ph.elements, s, touched);
  relabelled_ = false;
}

const Fragments& Cracks::fragments(const Model& m) {
  if (!relabelled_) fragments_.relabel(m.mesh, m.state.t);
  relabelled_ = true;
  return fragments_;
}

}  // namespace bw::csd
