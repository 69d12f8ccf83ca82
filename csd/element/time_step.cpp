// SPDX-License-Identifier: Apache-2.0
#include "csd/element/time_step.h"

#include <algorithm>
#include <cmath>

#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/stable_step.h"
#include "csd/rigid_blocks.h"

namespace bw::csd {

void TimeStep::share_masses(const Elements& el, const State& s) {
  if (mass_.empty()) {
    mass_.resize(size_t(el.blocks.slot_count()) * 8);
    for (size_t i = 0; i < mass_.size(); ++i)  // any weights: they are made to sum to the nodes' masses
      mass_[i] = float(s.V0[SlotId(int64_t(i / (8 * lanes) * lanes + i % lanes))]);
    distortion_.resize(s.V0.size(), 1);
  }
  Field<double, NodeId> sum(s.m.size());
  const auto at = [&](int block, int a, int l) { return size_t(block * 8 + a) * lanes + size_t(l); };
  if (s.local.most == 0)
    for_blocks(el.blocks, [&](int block, int) {
      if (is_rigid_block(s, block)) return;
      for_corners(lanes, [&](int a, int l) {
        const SlotId slot(block * lanes + l);
        mass_[at(block, a, l)] *= float(s.omega2[slot] * distortion_[slot]);
      });
    });
  for_coloured_blocks(el.blocks, [&](int block, int) {
    if (is_rigid_block(s, block)) return;
    add_to_corners(
        el.blocks, block, [&](int a, int l) { return double(mass_[at(block, a, l)]); }, sum);
  });
  el.finish_sum(sum);
  for_blocks(el.blocks, [&](int block, int) {
    if (is_rigid_block(s, block)) return;
    for_corners(lanes, [&](int a, int l) {
      const NodeId n(el.blocks.node[at(block, a, l)]);
      mass_[at(block, a, l)] = float(mass_[at(block, a, l)] / sum[n] * s.m[n]);
    });
  });
}

namespace {

/// Bound over centroid part, for the elements of a block; returns the largest relative change.
template <class M>
[[gnu::flatten]] double block_distortion(const Elements& el, const M& material, const double* history, int block,
                                         const Aligned<float>& masses, const State& s,
                                         Field<float, SlotId>& distortion) {
  Pack change(0);
  for (int l = 0; l < lanes; l += Pack::size) {
    const SlotId slot(block * lanes + l);
    Pack mass[8];
    for (int a = 0; a < 8; ++a) mass[a] = Pack::load(&masses[size_t(block * 8 + a) * lanes + size_t(l)]);
    const Pack V0 = Pack::load(&s.V0[slot]), volume = Pack::load(&s.volume[slot]);
    const Pack sigma = material.volumetric.mean_stress(volume / V0);
    const Corners<Pack> x = gather(s.x.data(), el.blocks.nodes_of(block) + l);
    const Pack bound = omega2_bound<Pack>(material, x, V0, mass, sigma, history + l);
    constexpr double up = 1 + 1e-7;  // rounding to single precision doesn't lower it
    const Pack now = Pack(up) * bound / Pack::load(&s.omega2[slot]), before = Pack::load(&distortion[slot]);
    change = max(abs(now - before) / before, change);
    now.store(&distortion[slot]);
  }
  double largest = 0;
  for (int i = 0; i < Pack::size; ++i) largest = std::fmax(largest, change[i]);
  return largest;
}

double renew_distortion(const Elements& el, const State& s, int block, int body, const Aligned<float>& masses,
                        Field<float, SlotId>& distortion) {
  return std::visit(
      [&]<class M>(const M& material) {
        HistoryBuffer<M> buffer;
        const double* history = s.history[size_t(body)].read(el.blocks.row_of(body, block), buffer.values);
        return block_distortion(el, material, history, block, masses, s, distortion);
      },
      el.materials[size_t(body)]);
}

/// Central differences with a damping matrix <= beta K are stable for dt <= 2/omega (sqrt(1 + xi^2) - xi), xi = beta
/// omega/2: the omega^2 of an undamped element with the same limit.
[[gnu::noinline]] Pack damped_omega2(Pack omega2, Pack beta) {
  const Pack xi = Pack(0.5) * beta * sqrt(omega2), grown = sqrt(Pack(1) + xi * xi) + xi;
  return omega2 * grown * grown;
}
/// 0 for elements of rigid bodies, which bound nothing.
Pack unless_rigid(const State& s, Pack value, SlotId first) {
  return s.rigid.size() > 0 ? select(Pack::load(&s.rigid[first]) > Pack(0), Pack(0), value) : value;
}
/// Of omega^2 of a block, to be compared by the shortest step.
double scale(const State& s, int block) {
  const double steps = s.local.steps_of_block(block);
  return steps * steps;
}

/// Bounds of a pack of elements, by their own step or by the shortest.
Pack own_omega2_of(const State& s, const Field<float, SlotId>& distortion, SlotId first) {
  const Pack omega2 = unless_rigid(s, Pack::load(&s.omega2[first]) * Pack::load(&distortion[first]), first);
  return s.viscous_time.size() > 0 ? damped_omega2(omega2, Pack::load(&s.viscous_time[first])) : omega2;
}
Pack omega2_of(const State& s, const Field<float, SlotId>& distortion, SlotId first) {
  return Pack(scale(s, first / lanes)) * own_omega2_of(s, distortion, first);
}

/// Of the elements of a block.
struct BlockState {
  double omega2 = 0;  ///< largest bound
  bool inverted = false, collapsed = false;
};
BlockState state_of(const State& s, const Field<float, SlotId>& distortion, int block) {
  Pack omega2(0), volume(1), collapsed(0);
  for (int l = 0; l < lanes; l += Pack::size) {
    const SlotId slot(block * lanes + l);
    omega2 = max(omega2_of(s, distortion, slot), omega2);  // not a number: not taken
    volume = select(Pack::load(&s.volume[slot]) > Pack(0), volume, Pack(0));
    collapsed = max(unless_rigid(s, Pack::load(&s.collapsed[slot]), slot), collapsed);
  }
  BlockState r{0, any(volume <= Pack(0)), any(collapsed > Pack(0))};
  for (int i = 0; i < Pack::size; ++i) r.omega2 = omega2[i] > r.omega2 ? omega2[i] : r.omega2;
  return r;
}

}  // namespace

double TimeStep::refresh(const Elements& el, const State& s, Which which) {
  if (which == Which::all) share_masses(el, s);
  std::vector<float> change(size_t(el.blocks.block_count()), 0);
  for_blocks(el.blocks, [&](int block, int body) {
    if (is_rigid_block(s, block)) return;
    if (which != Which::all) {
      const BlockState now = state_of(s, distortion_, block);
      if (!now.collapsed && (which == Which::collapsed || now.omega2 < stiff_part * omega2_)) return;
    }
    change[size_t(block)] = float(renew_distortion(el, s, block, body, mass_, distortion_));
  });
  double largest = 0;
  for (float c : change) largest = std::fmax(largest, double(c));
  return el.ranks ? el.ranks->comm().max(largest) : largest;
}

void TimeStep::refresh_all(const Elements& el, const State& s) {
  const bool settled = !stale_ && refreshes_ >= settling;
  const double change = refresh(el, s, settled && refreshes_ % whole_refresh != 0 ? Which::stiff : Which::all);
  interval_ = settled && change < calm ? std::min(2 * interval_, most_steps) : refresh_steps;
  refreshes_ = stale_ ? 1 : refreshes_ + 1;
  refreshed_at_ = s.step;
  stale_ = false;
}

void TimeStep::set_corner(const Elements& el, SlotId slot, int a, double mass) {
  const int block = slot / lanes, lane = slot % lanes, used = el.blocks.used[size_t(block)];
  for (int l = lane; l < (lane == used - 1 ? lanes : lane + 1); ++l)  // padding copies the last element
    mass_[size_t(block * 8 + a) * lanes + size_t(l)] = float(mass);
}

double TimeStep::borrowed(const Elements& el, ElemId e, const std::array<double, 8>& own) const {
  const SlotId slot = el.blocks.slot[e];
  double share = 0, mass = 0;
  for (int a = 0; a < 8; ++a) {
    share += mass_[size_t(slot / lanes * 8 + a) * lanes + size_t(slot % lanes)];
    mass += own[size_t(a)];
  }
  return share / mass;
}

void TimeStep::make_heavier(const Elements& el, ElemId e, const std::array<double, 8>& more) {
  const SlotId slot = el.blocks.slot[e];
  for (int a = 0; a < 8; ++a)
    set_corner(el, slot, a, mass_[size_t(slot / lanes * 8 + a) * lanes + size_t(slot % lanes)] + more[size_t(a)]);
}

void TimeStep::lend_nothing(const Mesh& mesh, const Elements& el, const State& s) {
  for (size_t e = 0; e < el.blocks.slot.size(); ++e)
    if (const SlotId slot = el.blocks.slot[ElemId(int64_t(e))]; el.blocks.is_own(slot))
      for (int a = 0; const double mass : corner_masses(mesh, el, ElemId(int64_t(e)))) set_corner(el, slot, a++, mass);
  for_blocks(el.blocks, [&](int block, int body) { renew_distortion(el, s, block, body, mass_, distortion_); });
}

void TimeStep::renew(const Mesh& mesh, const Topology& topology, const Elements& el, const State& s,
                     std::span<const NodeId> nodes) {
  if (stale_) return;
  std::vector<int> blocks;
  for (const NodeId n : nodes)
    for (const ElemId e : topology.elements(n)) {
      const SlotId slot = el.blocks.slot[e];
      if (!el.blocks.is_own(slot)) continue;
      blocks.push_back(slot / lanes);
      const auto own = corner_masses(mesh, el, e);
      for (int a = 0; a < 8; ++a)
        if (mesh.hex[e][size_t(a)] == n) set_corner(el, slot, a, own[size_t(a)]);
    }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  parallel_for_dynamic(int64_t(blocks.size()), [&](int64_t i) {
    const int block = blocks[size_t(i)];
    renew_distortion(el, s, block, el.body_of(SlotId(block * lanes)), mass_, distortion_);
  });
}

namespace {

struct Worst {
  double omega2 = 0;
  SlotId limiting, inverted;
  bool collapsed = false;
};
double element_omega2(const State& s, const Field<float, SlotId>& distortion, SlotId slot) {
  return omega2_of(s, distortion, SlotId(slot - slot % Pack::size))[slot % Pack::size];
}
Worst worst_of(const Elements& el, const State& s, const Field<float, SlotId>& distortion) {
  struct Blocks {
    BlockState state;
    int limiting = -1, inverted = -1;
  };
  const Blocks b = parallel_reduce(
      el.blocks.block_count(), Blocks{},
      [&](int64_t i) {
        const BlockState now = state_of(s, distortion, int(i));
        return Blocks{now, int(i), now.inverted ? int(i) : -1};
      },
      [](const Blocks& a, const Blocks& b) {  // a comes first: it wins ties
        const bool worse = b.state.omega2 > a.state.omega2;
        return Blocks{{worse ? b.state.omega2 : a.state.omega2, false, a.state.collapsed || b.state.collapsed},
                      worse ? b.limiting : a.limiting,
                      a.inverted >= 0 ? a.inverted : b.inverted};
      });
  Worst w{b.state.omega2, {}, {}, b.state.collapsed};
  const auto first = [&](int block, const auto& is_it) {
    for (SlotId slot(block * lanes); block >= 0 && slot < (block + 1) * lanes; slot = SlotId(slot + 1))
      if (is_it(slot)) return slot;
    return SlotId();
  };
  w.limiting = first(b.limiting, [&](SlotId i) { return element_omega2(s, distortion, i) == w.omega2; });
  w.inverted = first(b.inverted, [&](SlotId i) { return !(s.volume[i] > 0); });
  return w;
}

/// Exact; ties: lowest slot, whichever rank has it.
Worst worst_of_all(const Comm& comm, Worst w) {
  for (const Worst& b : comm.gather_one(w)) {
    if (b.omega2 > w.omega2 || (b.omega2 == w.omega2 && b.limiting < w.limiting)) w.limiting = b.limiting;
    w.omega2 = std::fmax(w.omega2, b.omega2), w.collapsed = w.collapsed || b.collapsed;
    if (b.inverted.valid() && !(w.inverted.valid() && w.inverted < b.inverted)) w.inverted = b.inverted;
  }
  return w;
}

}  // namespace

double TimeStep::omega2(const State& s, SlotId slot) const {
  return own_omega2_of(s, distortion_, SlotId(slot - slot % Pack::size))[slot % Pack::size];
}

double TimeStep::stable(const Elements& el, const State& s) {
  const auto worst = [&] {
    const Worst w = worst_of(el, s, distortion_);
    return el.ranks ? worst_of_all(el.ranks->comm(), w) : w;
  };
  const int64_t since = s.step - refreshed_at_;
  bool due = stale_ || since >= interval_;
  if (due) refresh_all(el, s);
  Worst w = worst();
  if (!due && since >= refresh_steps && std::abs(w.omega2 - refreshed_omega2_) > calm * refreshed_omega2_) {
    due = true;
    refresh_all(el, s), w = worst();
  }
  if (due) refreshed_omega2_ = w.omega2;
  if (w.collapsed && !due) {  // the centroid doesn't see a collapsing point: such elements are evaluated in every step
    refresh(el, s, Which::collapsed);
    w = worst();
  }
  limiting_ = w.limiting;
  inverted_ = w.inverted.valid() ? std::optional(w.inverted) : std::nullopt;
  omega2_ = w.omega2;
  refreshed_ = due;
  return s.local.shortest() * (2 / std::sqrt(w.omega2));
}

}  // namespace bw::csd
