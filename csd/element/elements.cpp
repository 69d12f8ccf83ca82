// SPDX-License-Identifier: Apache-2.0
#include "csd/element/elements.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/error.h"
#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/q1p0.h"
#include "csd/element/stable_step.h"

namespace bw::csd {

int Elements::body_of(SlotId slot) const {
  const auto& first = blocks.first_block;
  return int(std::upper_bound(first.begin(), first.end(), slot / lanes) - first.begin()) - 1;
}

namespace {

/// What bulk viscosity does to an element.
struct Viscous {
  Pack stress;  ///< Pa, added to sigma_m
  Pack beta;    ///< s, viscosity over stiffness: damping matrix <= beta K
};
[[gnu::noinline]] Viscous viscous_stress(const BulkViscosity& c, const Elastic& m, Pack V0, Pack volume, Pack before,
                                         double dt) {
  const Pack rate = min((volume - before) / (volume * Pack(dt)), Pack(0));  // of the volume, 1/s
  Pack h;
  for (int l = 0; l < Pack::size; ++l) h.set(l, std::cbrt(volume[l]));
  const Pack density = Pack(m.density) * V0 / volume;
  const Pack eta = density * h * (Pack(c.linear * m.sound_speed()) - Pack(c.quadratic * c.quadratic) * h * rate);
  const Pack stress = eta * rate;
  return {stress, eta / m.volumetric.stiffness(volume / V0)};
}

void scale(Corners<Pack>& f, double factor) {
  for (int a = 0; a < 8; ++a) f.a[a] = Pack(factor) * f.a[a];
}
/// Adds a block's forces by the levels to come; f: as impulses over the block's present step.
[[gnu::noinline]] void scatter_next(Corners<Pack> f, const int32_t* nodes, int count, double steps, int block,
                                    State& s) {
  scale(f, s.local.next_steps_of_block(block) / steps);
  scatter_add(f, nodes, count, s.next_sums.data());
}

/// Asks in good time for what the next block reads and adds to at its nodes: at four corners of each element, beside
/// which the others lie.
void fetch_next(const Blocks& blocks, int block, const State& s) {
  if (block + 1 == blocks.block_count()) return;
  const int32_t* nodes = blocks.nodes_of(block + 1);
  for (const int a : {0, 2, 5, 7})
    for (int l = 0; l < lanes; ++l) {
      const NodeId n(nodes[a * lanes + l]);
      __builtin_prefetch(&s.x[n]), __builtin_prefetch(&s.sums[n], 1);
    }
}

/// Forces of one block, none if it rests; returns the work spent in viscosity.
template <class M, class Mean>
[[gnu::flatten]] double block_force(const Elements& el, const M& material, int body, int block, const Mean& mean_of,
                                    double dt, bool rests, State& s) {
  const double per_dt = dt > 0 ? 1 / dt : 0;
  const double steps = s.local.steps_of_block(block);
  const bool is_last = s.local.is_pending() && s.local.all_due();  // before new levels
  PointHistory& histories = s.history[size_t(body)];
  const int row = el.blocks.row_of(body, block);
  HistoryBuffer<M> buffer;
  double* history = histories.read(row, buffer.values);
  const Skips skips{el.skip_elastic, el.skip_elastic && histories.is_uniform(row)};
  bool flowed = false;
  const int32_t* nodes = el.blocks.nodes_of(block);
  const int used = el.blocks.used[size_t(block)];
  double work = 0;
  fetch_next(el.blocks, block, s);
  for (int l = 0; l < lanes; l += Pack::size) {
    const SlotId slot(block * lanes + l);
    const Corners<Pack> x = gather(s.x.data(), nodes + l);
    const Pack V0 = Pack::load(&s.V0[slot]);
    Viscous viscous{Pack(0), Pack(0)};
    auto r = internal_force<Pack>(
        material, x, V0, history + l, [&](Pack J_bar) { return mean_of(material, slot, J_bar, V0, dt, viscous); },
        per_dt, skips);
    flowed |= r.flowed;
    if (rests) r.f = {};  // round-off
    if (steps > 1) scale(r.f, steps);
    const int count = std::min(used - l, Pack::size);
    if (const int32_t* places = el.blocks.border.of(block))
      scatter_border(r.f, nodes + l, places + l, count, s.sums.data(), el.blocks.border.vectors);
    else
      scatter_add(r.f, nodes + l, count, s.sums.data());
    if (is_last) scatter_next(r.f, nodes + l, count, steps, block, s);
    const Pack J_bar = r.volume / V0;
    const Pack omega2 =
        centroid_omega2(r.centre, J_bar, material.volumetric.stiffness(J_bar), material.mu, material.density);
    if constexpr (Mean::viscous) {
      viscous.beta.store(&s.viscous_time[slot]);
      const Pack mean = Pack(0.5) * (viscous.stress + Pack::load(&s.viscous_stress[slot]));
      const Pack change = mean * (r.volume - Pack::load(&s.volume[slot]));
      for (int i = 0; i < std::min(used - l, Pack::size); ++i) work += change[i];
      viscous.stress.store(&s.viscous_stress[slot]);
    }
    omega2.store(&s.omega2[slot]);
    r.volume.store(&s.volume[slot]);
    r.collapsed.store(&s.collapsed[slot]);
  }
  if (flowed) histories.write(row, history);
  return work;
}

/// Where the mean stress comes from, the usual cases: U', or a field.
struct Plain {
  static constexpr bool viscous = false;
  const Field<double, SlotId>* given;
  template <class M>
  Pack operator()(const M& m, SlotId slot, Pack J_bar, Pack, double, Viscous&) const {
    return given ? Pack::load(&(*given)[slot]) : m.volumetric.mean_stress(J_bar);
  }
};
/// The same with bulk viscosity.
struct WithViscosity {
  static constexpr bool viscous = true;
  const MeanStress& how;
  const Field<double, SlotId>& volume_before;
  template <class M>
  Pack operator()(const M& m, SlotId slot, Pack J_bar, Pack V0, double dt, Viscous& q) const {
    const Pack sigma = Plain{how.given}(m, slot, J_bar, V0, dt, q);
    if (dt > 0) q = viscous_stress(how.viscosity, m, V0, J_bar * V0, Pack::load(&volume_before[slot]), dt);
    return sigma + q.stress;
  }
};

/// Blocks ask eight times for each node.
void renew_moved(const State& s, const Reference& reference) {
  auto& has_moved = reference.resting.has_moved;
  has_moved.resize(reference.X.size());
  parallel_for(int64_t(has_moved.size()), [&](int64_t n) {
    has_moved[size_t(n)] = !(s.x[NodeId(n)] == reference.X[NodeId(n)]);
  });
}

/// Nodes where they were made, and no stress from a filter that blocks beside it have fed.
bool is_at_rest(const Elements& el, int block, int body, const MeanStress& how, const Resting& resting) {
  const int32_t* nodes = el.blocks.nodes_of(block);
  for (int i = 0; i < 8 * lanes; ++i)
    if (resting.has_moved[size_t(nodes[i])]) return false;
  if (!how.given) return true;
  const double noise = 1e-13 * std::visit([](const auto& m) { return m.volumetric.kappa; }, el.materials[size_t(body)]);
  for (int l = 0; l < lanes; ++l)
    if (!(std::abs((*how.given)[SlotId(block * lanes + l)]) <= noise)) return false;
  return true;
}
/// Whether a block rests. Looked at first, it is computed all the same: its volume and its bound are to be known. One
/// whose addends travel to other ranks is computed always.
Resting::State look_at(const Elements& el, int block, int body, const MeanStress& how, const Resting& resting) {
  const Resting::State before = resting.state[size_t(block)];
  if (before == Resting::rigid) return before;
  if (before == Resting::reached || !is_at_rest(el, block, body, how, resting)) return Resting::reached;
  const bool can_skip = resting.skip && before != Resting::unseen && !el.blocks.border.of(block);
  return can_skip ? Resting::skipped : Resting::computed;
}

/// Sum of the blocks' viscous work, in block order.
template <class Mean>
double all_forces(const Elements& el, const MeanStress& how, const Mean& mean_of, const Reference* reference,
                  State& s) {
  std::vector<double> work(Mean::viscous ? size_t(el.blocks.block_count()) : 0);
  if (reference && reference->resting.looks()) renew_moved(s, *reference);
  for_coloured_blocks(el.blocks, [&](int block, int body) {
    if (!s.local.is_block_due(block)) return;
    bool rests = false;
    if (reference) {
      const Resting::State now = look_at(el, block, body, how, reference->resting);
      reference->resting.state[size_t(block)] = now;
      if (now == Resting::skipped || now == Resting::rigid) return;
      rests = now == Resting::computed;
    }
    std::visit(
        [&](const auto& material) {
          const double dt = how.dt * s.local.steps_of_block(block);
          const double w = block_force(el, material, body, block, mean_of, dt, rests, s);
          if constexpr (Mean::viscous) work[size_t(block)] = w;
        },
        el.materials[size_t(body)]);
  });
  if (el.ranks && Mean::viscous) el.ranks->complete_blocks(work);
  double sum = 0;
  for (double w : work) sum += w;
  s.for_nodes([&](NodeId n) {
    PaddedPoint& f = s.sums[n];
    s.f[n] = s.local.per_step_of(n) * Vec3{f.x, f.y, f.z}, f = {};
  });
  el.finish_sum(s.f);
  return sum;
}

}  // namespace

double internal_force(const Elements& el, const MeanStress& how, State& s, const Reference* reference) {
  s.sums.resize(s.f.size());
  if (s.local.is_pending()) s.next_sums.resize(s.f.size());
  if (reference && !reference->resting.any()) reference = nullptr;
  if (how.viscosity.on() && s.viscous_stress.size() == 0)
    s.viscous_stress.resize(s.V0.size()), s.viscous_time.resize(s.V0.size());
  const double work = how.viscosity.on() ? all_forces(el, how, WithViscosity{how, s.volume}, reference, s)
                                         : all_forces(el, how, Plain{how.given}, reference, s);
  if (reference && s.local.all_due()) reference->resting.book();
  return work;
}

void take_next_sums(State& s) {
  s.for_nodes([&](NodeId n) {
    PaddedPoint& f = s.next_sums[n];
    s.f[n] = s.local.per_step_of(n) * Vec3{f.x, f.y, f.z}, f = {};
  });
}

namespace {

[[noreturn]] void refuse(const Mesh& mesh, ElemId e, const char* what, double value) {
  Vec3 c;
  for (NodeId n : mesh.hex[e]) c += 0.125 * mesh.X[n];
  throw InputError(
      fmt::format("mesh: element {} of body {} at ({:.6g}, {:.6g}, {:.6g}) m has {} {:.3g} m^3: its nodes are "
                  "in the wrong order or it is degenerate",
                  mesh.elem_gid[e], mesh.body[e], c.x, c.y, c.z, what, value));
}

/// Reference volume and history of one element in its lane; whether it is a parallelepiped, whose points remember the
/// same.
template <class M>
bool start_element(const Mesh& mesh, ElemId e, SlotId slot, double* history, State& s) {
  const Modes<double> modes = modes_of(corners(mesh, e));
  const Columns<double> g = columns_of(modes);
  s.V0[slot] = s.volume[slot] = volume_of(modes);
  if (!(s.V0[slot] > 0)) refuse(mesh, e, "volume", s.V0[slot]);
  double linear = 0, rest = 0;
  for (int i = 0; i < 7; ++i) (i < 3 ? linear : rest) += norm(modes.a[i]);
  const bool uniform = rest < 1e-12 * linear;
  for (int i = 0; i < 8; ++i) {
    const int from = uniform ? 0 : i;
    const Vec3 &g1 = g.at(0, from), &g2 = g.at(1, from), &g3 = g.at(2, from);
    const double det_g = triple(g1, g2, g3);
    if (!(det_g > 0)) refuse(mesh, e, "at an integration point a volume (8 det)", 8 * det_g);
    if (!history) continue;  // another rank's
    double* at_point = history + i * M::components * lanes;
    store_sym(at_point, metric(cross(g2, g3), cross(g3, g1), cross(g1, g2), 1 / (det_g * det_g)));
    for (int c = 6; c < M::components; ++c) at_point[c * lanes] = 0;
  }
  return uniform;
}

}  // namespace

void start(const Mesh& mesh, Elements& el, State& s) {
  s.resize(size_t(mesh.node_count()), size_t(el.blocks.slot_count()));
  s.x = mesh.X;
  s.history.clear();
  for (int body = 0; body < int(el.materials.size()); ++body) {
    const int first = el.blocks.first_block[size_t(body)], last = el.blocks.first_block[size_t(body) + 1];
    std::visit(
        [&]<class M>(const M&) {
          PointHistory& history = s.history.emplace_back(el.blocks.own_count(body), M::components, el.single_history);
          for (int block = first; block < last; ++block) {
            bool uniform = true;
            const auto start_lanes = [&](double* values) {
              for (int l = 0; l < lanes; ++l) {
                const SlotId slot(block * lanes + l);
                uniform &= start_element<M>(mesh, el.blocks.elem[slot], slot, values ? values + l : nullptr, s);
              }
            };
            if (!el.blocks.is_own(block)) {
              start_lanes(nullptr);
              continue;
            }
            const int row = el.blocks.row_of(body, block);
            history.change(row, start_lanes);
            if (uniform) history.set_uniform(row);
          }
        },
        el.materials[size_t(body)]);
  }
  for (int e = 0; e < mesh.elem_count(); ++e)
    for (int a = 0; const double mass : corner_masses(mesh, el, ElemId(e)))
      s.m[mesh.hex[ElemId(e)][size_t(a++)]] += mass;
}

[[gnu::noinline]] std::array<double, 8> corner_masses(const Mesh& mesh, const Elements& el, ElemId e) {
  const double density =
      std::visit([](const auto& material) { return material.density; }, el.materials[size_t(mesh.body[e])]);
  std::array<double, 8> mass = row_sums(corners(mesh, e));
  const double factor = el.mass_factor.empty() ? density : density * el.mass_factor[size_t(e)];
  for (double& m : mass) m *= factor;
  return mass;
}

double node_mass(const Mesh& mesh, const Elements& el, std::span<const ElemId> around, NodeId n) {
  double m = 0;
  for (ElemId e : around)
    for (int a = 0; const double mass : corner_masses(mesh, el, e))
      if (mesh.hex[e][size_t(a++)] == n) m += mass;
  return m;
}

}  // namespace bw::csd
