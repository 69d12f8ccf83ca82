// SPDX-License-Identifier: Apache-2.0
// A domain of one block, with walls in it: what the program does for many blocks, for the tests of the embedded
// boundary.
#pragma once
#include "cfd/embed/cut_kernel.h"
#include "cfd/embed/motion.h"
#include "cfd/embed/refill.h"
#include "cfd/embed/scan.h"
#include "embed_surfaces.h"

namespace bw::cfd::test {

template <class Mix>
struct OneBlock {
  using Eos = MixtureAtWall<Mix>;
  using W = std::array<double, Prim::count>;

  OneBlock(const Lattice& g, Mix m, GhostRule rule = GhostRule::mirror,
           WallTreatment treatment = WallTreatment::half_riemann)
      : lattice(g), mix(m), flow{m.closure()}, shape(shape_of(g)), cut(shape, treatment) {
    rules.fill(rule);
    patch = Patch(shape);
    patch.lower = g.lower;
    cuts = PatchCuts(shape);
    change = BlockChange(shape);
    u.resize(size_t(shape.cells()));
  }

  CellReader reader() const {
    return [this](const Index3& c, double* U) {
      std::copy_n(u[shape.at(c[2], c[1], c[0])].begin(), int(Cons::count), U);
    };
  }
  static BlockShape shape_of(const Lattice& g) {
    BlockShape s;
    for (size_t d = 0; d < 3; ++d) s.n[d] = g.n[d], s.used[d] = g.n[d] > 1;
    s.h = g.h;
    return s;
  }
  /// State of every cell: paint(x) -> rho1*alpha1, rho2*alpha2, v, p, alpha1.
  template <class Paint>
  void paint(const Paint& paint) {
    for_cells([&](int k, int j, int i) { set(k, j, i, paint(lattice.centre({i, j, k}))); });
  }
  void set(int k, int j, int i, const W& w) {
    double full[Prim::stored] = {}, out[Cons::count];
    for (int q = 0; q < Prim::count; ++q) full[q] = w[size_t(q)];
    mix.to_conserved(full, out);
    for (int q = 0; q < Cons::count; ++q) u[shape.at(k, j, i)][size_t(q)] = out[q];
  }
  W get(int k, int j, int i) const {
    double in[Cons::count], out[Prim::stored];
    for (int q = 0; q < Cons::count; ++q) in[q] = u[shape.at(k, j, i)][size_t(q)];
    mix.to_primitive(in, out, {});
    W w;
    for (int q = 0; q < Prim::count; ++q) w[size_t(q)] = out[q];
    return w;
  }
  bool blocked(int k, int j, int i) const { return map.blocked({i, j, k}); }

  void place(const WetSurface& s) {
    surface = s;
    scan(surface, lattice, map);
    if (!acceleration.empty()) update_accelerations(surface, acceleration, map);
    cuts.gather(map, rules, {});
  }
  /// Moves the nodes with their velocities for dt, refills.
  Changes move(double dt) {
    const std::vector<Vec3> before = surface.x;
    for (size_t i = 0; i < before.size(); ++i) surface.x[i] += dt * surface.v[i];
    CutMap now;
    scan(surface, lattice, now);
    Changes changes = compare(map, now, swept_cells(surface, before, lattice));
    for (const Index3& c : changes.covered) removed += density(c);
    for (int layer = 1; layer <= changes.layers; ++layer) {
      for (const FreshCell& f : changes.fresh)
        if (f.layer == layer) {
          const auto& c = f.cell;
          if (!map.blocked(c)) removed += density(c);
          double U[Cons::count];
          EXPECT_TRUE(cfd::refill(now, c, mixture, {}, reader(), U));
          std::copy_n(U, int(Cons::count), u[shape.at(c[2], c[1], c[0])].begin());
          added += density(c);
          ++refilled;
        }
      for (const FreshCell& f : changes.fresh)
        if (f.layer == layer) now.drop_flag(f.cell, cell_fresh);
    }
    map = now;
    cuts.gather(map, rules, {});
    return changes;
  }
  void advance(double dt) {
    fill_patch();
    kernel.advance(patch, flow, dt, change, cuts.any() ? &cut.prepare(patch, cuts, flow, Eos{mix}, dt) : nullptr);
    exchange = {};
    if (cuts.any()) cut.correct(change, exchange);
    for_cells([&](int k, int j, int i) {
      if (blocked(k, j, i)) return;
      for (int q = 0; q < Cons::count; ++q) u[shape.at(k, j, i)][size_t(q)] += change.row(q, k, j)[i];
    });
  }
  double largest_rate() const {
    double most = 0;
    for (int k = 0; k < shape.n[2]; ++k)
      for (int j = 0; j < shape.n[1]; ++j)
        for (int i = 0; i < shape.n[0]; ++i) {
          if (blocked(k, j, i)) continue;
          double in[Cons::count], w[Prim::stored], sum = 0;
          for (int q = 0; q < Cons::count; ++q) in[q] = u[shape.at(k, j, i)][size_t(q)];
          mix.to_primitive(in, w, {});
          for (int d = 0; d < 3; ++d)
            if (shape.used[size_t(d)]) sum += (std::abs(w[Prim::v + d]) + w[Prim::c]) / shape.h[d];
          most = std::max(most, sum);
        }
    return most;
  }
  double density(const Index3& c) const {
    const auto& U = u[shape.at(c[2], c[1], c[0])];
    return (U[Cons::arho1] + U[Cons::arho2]) * shape.cell_volume();
  }
  double mass() const {
    double sum = 0;
    for (int k = 0; k < shape.n[2]; ++k)
      for (int j = 0; j < shape.n[1]; ++j)
        for (int i = 0; i < shape.n[0]; ++i)
          if (!blocked(k, j, i)) sum += density({i, j, k});
    return sum;
  }
  template <class Body>
  void for_cells(const Body& body) {
    for (int k = 0; k < shape.n[2]; ++k)
      for (int j = 0; j < shape.n[1]; ++j)
        for (int i = 0; i < shape.n[0]; ++i) body(k, j, i);
  }

  void fill_patch() {
    const int g0 = shape.ghost(0), g1 = shape.ghost(1), g2 = shape.ghost(2);
    for (int k = -g2; k < shape.n[2] + g2; ++k)
      for (int j = -g1; j < shape.n[1] + g1; ++j)
        for (int i = -g0; i < shape.n[0] + g0; ++i) {
          const int index[3] = {i, j, k};
          int from[3];
          bool flip[3] = {};
          for (int d = 0; d < 3; ++d) {
            const int n = shape.n[size_t(d)];
            from[d] = index[d];
            if (from[d] >= 0 && from[d] < n) continue;
            const bool up = from[d] >= n;
            switch (rules[size_t(2 * d + up)]) {
              case GhostRule::mirror:
                from[d] = up ? 2 * n - 1 - from[d] : -1 - from[d], flip[d] = true;
                break;
              case GhostRule::copy:
                from[d] = up ? n - 1 : 0;
                break;
              case GhostRule::periodic:
                from[d] += up ? -n : n;
                break;
            }
          }
          double in[Cons::count], w[Prim::stored];
          for (int q = 0; q < Cons::count; ++q) in[q] = u[shape.at(from[2], from[1], from[0])][size_t(q)];
          mix.to_primitive(in, w, {});
          for (int d = 0; d < 3; ++d)
            if (flip[d]) w[Prim::v + d] = -w[Prim::v + d];
          for (int q = 0; q < Prim::stored; ++q) patch.row(q, k, j)[i] = w[q];
        }
  }

  Lattice lattice;
  Mix mix;
  Mixture mixture = make_mixture(mix.m1, mix.m2);
  MixedFlow flow;
  BlockShape shape;
  GhostRules rules{};
  Patch patch;
  PatchCuts cuts;
  BlockChange change;
  std::vector<std::array<double, Cons::count>> u;
  WetSurface surface;
  std::vector<Vec3> acceleration;  // [n_nodes]; empty: none
  CutMap map;
  WallExchange exchange;
  double added = 0, removed = 0;  // kg by refilling and covering
  int64_t refilled = 0;
  BlockKernel<MixedFlow, Pack> kernel{shape};
  CutKernel<Eos> cut;
};

using TwoGases = FiveEquation<IdealGas, IdealGas>;
/// Gas 2 (material 1 absent).
inline std::array<double, Prim::count> gas(double rho, const Vec3& v, double p) {
  return {0, rho, v.x, v.y, v.z, p, 0, 0};
}
inline std::array<double, Prim::count> gas_1(double rho, const Vec3& v, double p) {
  return {rho, 0, v.x, v.y, v.z, p, 1, 0};
}

}  // namespace bw::cfd::test
