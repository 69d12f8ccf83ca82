// SPDX-License-Identifier: Apache-2.0
// The gas at a wall, in the rows of a flow model (cfd/scheme/flow_model.h): its equation of state, its state at the
// wall, and the one-sided line through that state.
#pragma once
#include <array>
#include <cmath>
#include <type_traits>

#include "cfd/embed/cut_map.h"
#include "cfd/embed/wall_state.h"
#include "cfd/scheme/flow_model.h"

namespace bw::cfd {

/// Equation of state of GasFlow. G(): sum alpha (1 - b rho)/Gruneisen; sum(): Pi and the part of G rho c^2 that does
/// not depend on p; taken(): sum alpha b rho, the part of the volume that covolumes take up.
struct GasAtWall {
  using Flow = GasFlow;
  double over_G, Pi;
  template <class W>
  double G(const W&) const {
    return over_G;
  }
  template <class W>
  double G_without_covolume(const W&) const {
    return over_G;
  }
  template <class W>
  double taken(const W&) const {
    return 0;
  }
  template <class W>
  PiTerms<double> sum(const W&) const {
    return {Pi, 0, Pi};
  }
  template <class W>
  bool ideal(const W&) const {
    return true;
  }
};

/// Equation of state of MixedFlow.
template <class Mix>
struct MixtureAtWall {
  using Flow = MixedFlow;
  const Mix& mix;
  template <class W>
  double G(const W& w) const {
    return mix.closure().G(w[Prim::alpha1], w[Prim::arho1], w[Prim::arho2]);
  }
  template <class W>
  double G_without_covolume(const W& w) const {
    return mix.closure().G(w[Prim::alpha1], 0.0, 0.0);
  }
  template <class W>
  double taken(const W& w) const {
    return mix.m1.covolume() * w[Prim::arho1] + mix.m2.covolume() * w[Prim::arho2];
  }
  template <class W>
  PiTerms<double> sum(const W& w) const {
    return mix.pi_sum(w[Prim::arho1], w[Prim::arho2], w[Prim::alpha1]);
  }
  template <class W>
  bool ideal(const W& w) const {
    constexpr bool first = std::decay_t<decltype(mix.m1)>::constant_reference,
                   second = std::decay_t<decltype(mix.m2)>::constant_reference;
    return (first || w[Prim::alpha1] == 0) && (second || w[Prim::alpha1] == 1);
  }
};

/// Of more than two materials.
template <int K>
struct MixtureAtWall<ManyMaterials<K>> {
  using Flow = ManyFlow<K>;
  const ManyMaterials<K>& mix;
  template <class W>
  double G(const W& w) const {
    return G_without_covolume(w) - over([&](size_t k) { return w[FaceRow::arho(int(k))] * mix.b_G[k]; });
  }
  template <class W>
  double G_without_covolume(const W& w) const {
    return over([&](size_t k) { return w[FaceRow::alpha(int(k))] * mix.over_G[k]; });
  }
  template <class W>
  double taken(const W& w) const {
    return over([&](size_t k) { return w[FaceRow::arho(int(k))] * mix.b_G[k] / mix.over_G[k]; });
  }
  template <class W>
  PiTerms<double> part(const W& w, int k) const {
    return mix.part(k, w[FaceRow::arho(k)], w[FaceRow::alpha(k)]);
  }
  template <class W>
  PiTerms<double> sum(const W& w) const {
    PiTerms<double> all{0, 0, 0};
    for (int k = 0; k < K; ++k) {
      const PiTerms<double> own = part(w, k);
      all.pi += own.pi, all.dpi += own.dpi, all.stiffness += own.stiffness;
    }
    return all;
  }
  template <class W>
  bool ideal(const W& w) const {
    bool all = true;
    for (int k = 0; k < K; ++k)
      all = all && (w[FaceRow::alpha(k)] == 0 || std::holds_alternative<ConstantReference>(mix.form[size_t(k)]));
    return all;
  }

 private:
  template <class Term>
  static double over(const Term& term) {
    double sum = 0;
    for (size_t k = 0; k < K; ++k) sum += term(k);
    return sum;
  }
};

template <class Eos>
struct WallGas {
  using Flow = typename Eos::Flow;
  static constexpr int n = Flow::n, v = Flow::v, p = Flow::p, densities = Flow::materials;
  using State = std::array<double, size_t(n)>;
  Eos eos;

  static double rho(const State& w) {
    double sum = w[0];
    for (int k = 1; k < densities; ++k) sum += w[size_t(FaceRow::arho(k))];
    return sum;
  }
  static Vec3 velocity(const State& w) { return {w[v], w[v + 1], w[v + 2]}; }
  double stiffness(const State& w, double pressure) const {
    return (eos.sum(w).stiffness + pressure * (1 + eos.G_without_covolume(w))) / eos.G(w);
  }
  double stiffness(const State& w) const { return stiffness(w, w[p]); }
  /// Pi of rho e = G p + Pi.
  double pi(const State& w) const { return eos.sum(w).pi; }

  /// The state at a wall.
  struct AtWall {
    State w;
    double rho_c2;
  };
  /// Next to the gas w: the wall's normal velocity, the gas's tangential one, its composition. A gas with a covolume is
  /// one without in the volume that is left [Toro 1.2.5]: 1/rho - b for 1/rho; p and velocities are the same.
  AtWall at_wall(const State& w, const Vec3& normal, const Vec3& v_wall) const {
    const double dv = dot(v_wall - velocity(w), normal);
    const double K = std::max(stiffness(w), 1e-12 * w[p]);
    if (dv == 0) return {w, K};
    const double taken = eos.taken(w), free = 1 - taken;
    const auto denser = [&](double ratio) {
      return ratio / (free + taken * ratio);
    };  // of the whole, by that of what is left
    WallStar star =
        wall_star(rho(w) / free, w[p], K * free, eos.G(w) / free, dv, eos.ideal(w), [&](double ratio, double pressure) {
          State at = w;
          for (int k = 0; k < densities; ++k) at[size_t(FaceRow::arho(k))] *= denser(ratio);
          return stiffness(at, pressure) * (1 - taken * denser(ratio));
        });
    star.compress = denser(star.compress);
    if (!std::isfinite(star.p) || !std::isfinite(star.compress))
      return {w, K};  // no gas to speak of: it keeps what it has
    State at = w;
    for (int k = 0; k < densities; ++k) at[size_t(FaceRow::arho(k))] *= star.compress;
    at[p] = star.p;
    for (int d = 0; d < 3; ++d) at[size_t(v + d)] += dv * normal[d];
    if constexpr (Flow::mixed) at[Prim::Pi] = eos.sum(at).pi;
    return {at, std::max(stiffness(at), 0.0)};
  }

  /// Density on the isentrope through w where the pressure is p; the sound speed at w sets the gas.
  double on_isentrope(const State& w, double pressure) const {
    const double taken = eos.taken(w), free = 1 - taken, K = std::max(stiffness(w), 1e-12 * w[p]);
    const detail::LocalGas g(w[p], K * free, eos.G(w) / free);
    const double ratio = std::pow(std::max((pressure + g.p_inf) / g.P, wall_vacuum), 1 / g.gamma);
    return rho(w) * ratio / (free + taken * ratio);
  }
  /// ln of the density of w over that on the isentrope through `other`.
  double denser_than_isentrope(const State& w, const State& other) const {
    return std::log(rho(w) / on_isentrope(other, w[p]));
  }
  /// Densities of `out`, whose pressure is set: of the isentrope through w, times `factor`.
  void put_on_isentrope(const State& w, double factor, State& out) const {
    const double ratio = factor * on_isentrope(w, out[p]) / rho(w);
    for (int k = 0; k < densities; ++k) out[size_t(FaceRow::arho(k))] = ratio * w[size_t(FaceRow::arho(k))];
    if constexpr (Flow::mixed) out[Prim::Pi] = eos.sum(out).pi;
  }

  /// w + share (w - other), the line from a neighbour through w prolonged towards a wall: less of it where density or
  /// pressure would change by more than a factor of two. Composition is w's; where it varies, so are the densities.
  static State beyond(const State& w, const State& other, double share) {
    State out = w;
    double keep = 1;
    auto limit = [&](double here, double there) {
      const double change = share * (here - there);
      if (change < -0.5 * here) keep = std::min(keep, 0.5 * here / -change);
      if (change > here) keep = std::min(keep, here / change);
    };
    limit(w[p], other[p]);
    const bool uniform = same_composition(w, other);
    if (uniform) limit(rho(w), rho(other));
    const double s = keep * share;
    if (uniform)
      for (int k = 0; k < densities; ++k) {
        const size_t q = size_t(FaceRow::arho(k));
        out[q] += s * (w[q] - other[q]);
      }
    for (int q = v; q <= p; ++q) out[size_t(q)] += s * (w[size_t(q)] - other[size_t(q)]);
    return out;
  }

  /// star + share (other - star) with the composition of `own`; star itself where that is no gas.
  static State on_line(const State& star, const State& other, const State& own, double share) {
    State out = star;
    const bool uniform = same_composition(own, other);
    for (int q = 0; q < n; ++q)
      if (uniform || (q >= v && q <= p)) out[size_t(q)] += share * (other[size_t(q)] - star[size_t(q)]);
    const bool physical =
        out[p] > 0.2 * star[p] && rho(out) > 0.2 * rho(star) && out[p] < 5 * star[p] && rho(out) < 5 * rho(star);
    return physical ? out : star;
  }

  static bool same_composition(const State& a, const State& b) {
    bool same = true;
    if constexpr (Flow::mixed)
      for (int k = 0; k < densities - (densities == 2); ++k) {
        const size_t q = size_t(FaceRow::alpha(k));
        same = same && std::abs(a[q] - b[q]) < 1e-10;
      }
    return same;
  }
};

}  // namespace bw::cfd
