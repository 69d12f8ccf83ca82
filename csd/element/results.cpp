// SPDX-License-Identifier: Apache-2.0
#include "csd/element/results.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/parallel/loop.h"
#include "csd/element/lanes.h"
#include "csd/element/q1p0.h"
#include "csd/rigid_blocks.h"

namespace bw::csd {
namespace {

/// An element's history.
template <class M>
class HistoryOf {
 public:
  HistoryOf(const Elements& el, const State& s, int body, SlotId slot)
      : values_(s.history[size_t(body)].read(el.blocks.row_of(body, slot / lanes), buffer_.values) + slot % lanes) {}
  const double* at(int point) const { return values_ + point * M::components * lanes; }

 private:
  HistoryBuffer<M> buffer_;
  const double* values_;
};

Corners<double> corners_at(const Elements& el, const State& s, SlotId slot) {
  const int32_t* n = el.blocks.nodes_of(slot / lanes) + slot % lanes;
  Corners<double> x;
  for (int a = 0; a < 8; ++a) x.a[a] = s.x[NodeId(n[a * lanes])];
  return x;
}

template <class M>
ElementResult evaluate_as(const M& material, const Corners<double>& x, double V0, const double* history,
                          const double* sigma_m) {
  const Modes<double> modes = modes_of(x);
  const Columns<double> g = columns_of(modes);
  const double volume = volume_of(modes), J_bar = volume / V0;
  ElementResult r;
  r.elastic = V0 * material.volumetric.energy(J_bar);
  bool collapsed = false;
  for (int i = 0; i < 8; ++i) {
    const double* at_point = history + i * M::components * lanes;
    const Point<double> p(g.at(0, i), g.at(1, i), g.at(2, i), load_sym<double>(at_point));
    // what has flowed is in the history, so the stress is elastic in it: eq (6)
    const double iso = p.trial.iso, J = std::sqrt(p.trial.J_squared), point_V0 = p.det_g / J;
    r.sigma = r.sigma + (p.det_g * material.mu * iso / J) * p.dev_b;
    r.elastic += point_V0 * 1.5 * material.mu * (iso * p.trial.third_trace - 1);
    if constexpr (M::plastic) {
      const double eqps = at_point[6 * lanes], work = material.plastic_work(at_point);
      r.eqps += 0.125 * eqps;
      r.eqps_max = std::max(r.eqps_max, eqps);
      r.plastic += point_V0 * work;
      if (material.heat.specific_heat > 0) r.heat += point_V0 * material.heat.taylor_quinney * work;
      const double temperature = material.temperature(at_point);
      r.temperature += 0.125 * temperature;
      r.temperature_max = std::max(r.temperature_max, temperature);
    }
    collapsed |= p.trial.J_squared < collapse_ratio * collapse_ratio * J_bar * J_bar || p.det_g <= 0;
  }
  const double mean = sigma_m ? *sigma_m : material.volumetric.mean_stress(J_bar);
  r.sigma = (1 / volume) * r.sigma + Sym3{mean, mean, mean, 0, 0, 0};
  if (collapsed) {
    Columns<double> unused{};
    double unused_stress = 0;
    r.collapse =
        collapse_guard(g, history, M::components, J_bar, volume, material.volumetric.kappa, unused, unused_stress);
  }
  return r;
}

/// Sums over a block, Pack::size elements at a time.
template <class M>
StoredEnergy stored_in_block(const Elements& el, const M& material, const State& s, int body, int block) {
  HistoryBuffer<M> buffer;
  const double* history = s.history[size_t(body)].read(el.blocks.row_of(body, block), buffer.values);
  constexpr int stride = M::components * lanes;
  StoredEnergy sum;
  for (int first = 0; first < el.blocks.used[size_t(block)]; first += Pack::size) {
    const Modes<Pack> modes = modes_of(gather(s.x.data(), el.blocks.nodes_of(block) + first));
    const Columns<Pack> g = columns_of(modes);
    Points<Pack> p;
    Pack least_det(1e300), least_squared(1e300);
    for (int i = 0; i < 8; ++i) {
      convect(load_sym<Pack>(history + i * stride + first), g.at(0, i), g.at(1, i), g.at(2, i), i, p);
      least_det = min(least_det, p.det_g[i]), least_squared = min(least_squared, p.J_squared[i]);
    }
    inverse_sixth_roots(p.J_squared, p.root);
    const Pack V0 = Pack::load(&s.V0[SlotId(block * lanes + first)]), volume = volume_of(modes), J_bar = volume / V0;
    Pack elastic = V0 * material.volumetric.energy(J_bar), collapse(0), point_V0[8];
    for (int i = 0; i < 8; ++i) {
      const Pack iso = p.root[i] * p.root[i];
      point_V0[i] = p.det_g[i] * iso * p.root[i];
      elastic += point_V0[i] * Pack(1.5 * material.mu) * (iso * p.third_trace[i] - Pack(1));
    }
    if (any((least_squared < Pack(collapse_ratio * collapse_ratio) * J_bar * J_bar) | (least_det <= Pack(0))))
        [[unlikely]] {
      Columns<Pack> unused{};
      Pack unused_stress(0);
      collapse = collapse_guard(g, history + first, M::components, J_bar, volume, Pack(material.volumetric.kappa),
                                unused, unused_stress);
    }
    for (int l = 0; l < std::min(el.blocks.used[size_t(block)] - first, Pack::size); ++l) {
      sum.elastic += elastic[l], sum.collapse += collapse[l];
      if constexpr (M::plastic)
        for (int i = 0; i < 8; ++i) {
          const double *at_point = history + i * stride + first + l, work = material.plastic_work(at_point);
          sum.plastic += point_V0[i][l] * work;
          if (material.heat.specific_heat > 0) sum.heat += point_V0[i][l] * material.heat.taylor_quinney * work;
          sum.eqps_max = std::max(sum.eqps_max, at_point[6 * lanes]);
          sum.temperature_max = std::max(sum.temperature_max, material.temperature(at_point));
        }
    }
  }
  return sum;
}

}  // namespace

double von_mises(const Sym3& sigma) {
  const Sym3 s = deviator(sigma);
  return std::sqrt(1.5 * contract(s, s));
}

ElementResult evaluate(const Elements& el, const State& s, SlotId slot, const Field<double, SlotId>* sigma_m) {
  const int body = el.body_of(slot);
  return std::visit(
      [&]<class M>(const M& material) {
        return evaluate_as(material, corners_at(el, s, slot), s.V0[slot], HistoryOf<M>(el, s, body, slot).at(0),
                           sigma_m ? &(*sigma_m)[slot] : nullptr);
      },
      el.materials[size_t(body)]);
}

Corners<double> element_force(const Elements& el, const State& s, SlotId slot) {
  const int body = el.body_of(slot);
  return std::visit(
      [&]<class M>(const M& material) {
        // what has flowed is in the history, so the stress is elastic in it
        NeoHooke elastic;
        static_cast<Elastic&>(elastic) = material;
        double A[8 * NeoHooke::components * lanes];
        const HistoryOf<M> history(el, s, body, slot);
        for (int i = 0; i < 8; ++i) store_sym(A + i * NeoHooke::components * lanes, load_sym<double>(history.at(i)));
        const auto mean_stress = [&](double J_bar) { return material.volumetric.mean_stress(J_bar); };
        return internal_force<double>(elastic, corners_at(el, s, slot), s.V0[slot], A, mean_stress, 0).f;
      },
      el.materials[size_t(body)]);
}

StoredEnergy stored_energy(const Elements& el, const State& s, int block) {
  const int body = el.body_of(SlotId(block * lanes));
  return std::visit([&](const auto& m) { return stored_in_block(el, m, s, body, block); },
                    el.materials[size_t(body)]);
}

StoredEnergy stored_energy(const Elements& el, const State& s) {
  std::vector<StoredEnergy> of_blocks(size_t(el.blocks.block_count()));
  for_blocks(el.blocks, [&](int block, int) {
    of_blocks[size_t(block)] = is_rigid_block(s, block) ? s.of_rigid[size_t(block)] : stored_energy(el, s, block);
  });
  if (el.ranks) el.ranks->complete_blocks(of_blocks);
  StoredEnergy all;
  for (const StoredEnergy& e : of_blocks) all.add(e);
  return all;
}

bool heats(const Elements& el, int body) {
  return std::visit(
      []<class M>(const M& material) {
        if constexpr (M::plastic) return material.heat.specific_heat > 0;
        return false;
      },
      el.materials[size_t(body)]);
}

double flow_stress(const Elements& el, const State& s, SlotId slot, double rate) {
  const int body = el.body_of(slot);
  return std::visit(
      [&]<class M>(const M& material) {
        double sum = 0;
        if constexpr (M::plastic) {
          const HistoryOf<M> history(el, s, body, slot);
          for (int i = 0; i < 8; ++i) {
            const double* at_point = history.at(i);
            if constexpr (requires { material.flow.stress(0.0); })
              sum += material.flow.stress(at_point[6 * lanes]);
            else
              sum += material.flow.at(material.temperature(at_point)).stress(at_point[6 * lanes], rate).value;
          }
        }
        return 0.125 * sum;
      },
      el.materials[size_t(body)]);
}

double mean_stress(const Elements& el, const State& s, SlotId slot) {
  return std::visit([&](const auto& m) { return m.volumetric.mean_stress(s.volume[slot] / s.V0[slot]); },
                    el.materials[size_t(el.body_of(slot))]);
}

double mises_most(const Elements& el, const State& s, SlotId slot) {
  const int body = el.body_of(slot);
  return std::visit(
      [&]<class M>(const M& material) {
        double most = std::numeric_limits<double>::infinity();
        if constexpr (M::plastic)
          if constexpr (requires { material.flow.stress(0.0); }) {
            most = 0;  // Kirchhoff, at the points
            const HistoryOf<M> history(el, s, body, slot);
            for (int i = 0; i < 8; ++i) most = std::max(most, material.flow.stress(history.at(i)[6 * lanes]));
            most *= (1 + 1e-6) * s.V0[slot] / s.volume[slot];
          }
        return most;
      },
      el.materials[size_t(body)]);
}

double density(const Elements& el, SlotId slot) {
  return std::visit([](const auto& material) { return material.density; }, el.materials[size_t(el.body_of(slot))]);
}

double mean_eqps(const Elements& el, const State& s, SlotId slot) {
  const int body = el.body_of(slot);
  return std::visit(
      [&]<class M>(const M&) {
        double sum = 0;
        if constexpr (M::plastic) {
          const HistoryOf<M> history(el, s, body, slot);
          for (int i = 0; i < 8; ++i) sum += history.at(i)[6 * lanes];
        }
        return 0.125 * sum;
      },
      el.materials[size_t(body)]);
}

void mean_eqps(const Elements& el, const State& s, int block, int body, double* eqps) {
  std::visit(
      [&]<class M>(const M&) {
        std::fill_n(eqps, lanes, 0.0);
        if constexpr (M::plastic) {
          const HistoryOf<M> history(el, s, body, SlotId(block * lanes));
          for (int i = 0; i < 8; ++i)
            for (int l = 0; l < lanes; ++l) eqps[l] += history.at(i)[6 * lanes + l];
          for (int l = 0; l < lanes; ++l) eqps[l] *= 0.125;
        }
      },
      el.materials[size_t(body)]);
}

}  // namespace bw::csd
