// SPDX-License-Identifier: Apache-2.0
// Small models for the tests of element, material and step.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/math/random.h"
#include "csd/element/lanes.h"
#include "csd/element/q1p0.h"
#include "csd/element/results.h"
#include "csd/mesh/box.h"
#include "csd/mesh/input.h"
#include "csd/step.h"

namespace bw::csd {

/// Goes into the test's report: run/verify shows it.
inline void record(const char* name, double value) {
  testing::Test::RecordProperty(name, fmt::format("{:.3g}", value));
}

inline const Elastic copper{8930, 117e9, 0.35};
inline J2<LinearFlow> copper_j2() { return {copper, LinearFlow{400e6, 100e6}}; }
inline NeoHooke copper_elastic() { return {8930, 117e9, 0.35}; }

/// In [-1, 1), a function of its arguments.
inline double noise(uint64_t seed, uint64_t i) { return 2 * uniform01(seed, i) - 1; }

/// Cube [-1, 1]^3 times h/2, its corners moved at random by up to `perturbation` h.
inline Corners<double> random_hex(uint64_t seed, double perturbation, double h = 1) {
  Corners<double> x;
  for (int a = 0; a < 8; ++a)
    for (int d = 0; d < 3; ++d)
      x.a[a][d] = h * (0.5 * node_sign[a][d] + perturbation * noise(seed, uint64_t(3 * a + d)));
  return x;
}
inline Corners<double> shaken(const Corners<double>& x, uint64_t seed, double size) {
  Corners<double> y = x;
  for (int a = 0; a < 8; ++a)
    for (int d = 0; d < 3; ++d) y.a[a][d] += size * noise(seed, uint64_t(a * 3 + d));
  return y;
}
inline Corners<double> mapped(const Corners<double>& X, const std::function<Vec3(const Vec3&)>& map) {
  Corners<double> x;
  for (int a = 0; a < 8; ++a) x.a[a] = map(X.a[a]);
  return x;
}

/// One element with its history, in the storage that the kernel uses (lane 0).
template <class M>
struct OneElement {
  M material;
  Corners<double> X;
  double V0;
  Aligned<double> history = Aligned<double>(8 * M::components * lanes, 0.0);

  OneElement(const M& material, const Corners<double>& X) : material(material), X(X), V0(volume_of(modes_of(X))) {
    const Columns<double> g = columns_of(modes_of(X));
    for (int i = 0; i < 8; ++i) {
      const double det = triple(g.at(0, i), g.at(1, i), g.at(2, i));
      store_sym(&history[size_t(i * M::components * lanes)],
                metric(cross(g.at(1, i), g.at(2, i)), cross(g.at(2, i), g.at(0, i)), cross(g.at(0, i), g.at(1, i)),
                       1 / (det * det)));
    }
  }
  double J0(int i) const { return 1 / std::sqrt(det(load_sym<double>(at(i)))); }
  const double* at(int i) const { return &history[size_t(i * M::components * lanes)]; }
  double eqps(int i) const { return at(i)[6 * lanes]; }
  /// Forces at x, dt after the last ones (0: no time passed); commits.
  ElementForce<double> force(const Corners<double>& x, double dt = 0) {
    return internal_force<double>(
        material, x, V0, history.data(), [&](double J) { return material.volumetric.mean_stress(J); },
        dt > 0 ? 1 / dt : 0);
  }
  Point<double> point(const Corners<double>& x, int i) const {
    const Columns<double> g = columns_of(modes_of(x));
    return {g.at(0, i), g.at(1, i), g.at(2, i), load_sym<double>(at(i))};
  }
  /// Cauchy stress at a point for the history as it is.
  Sym3 cauchy(const Corners<double>& x, int i) const {
    const Point<double> p = point(x, i);
    const double J = std::sqrt(p.trial.J_squared), k = material.mu * p.trial.iso;
    const double sigma_m = material.volumetric.mean_stress(volume_of(modes_of(x)) / V0);
    return (k / J) * p.dev_b + Sym3{sigma_m, sigma_m, sigma_m, 0, 0, 0};
  }
  /// Elastic energy at x for the history as it is (no flow), VALIDATION A.3.
  double energy(const Corners<double>& x) const {
    double e = V0 * material.volumetric.energy(volume_of(modes_of(x)) / V0);
    for (int i = 0; i < 8; ++i) {
      const Point<double> p = point(x, i);
      e += J0(i) * 1.5 * material.mu * (p.trial.iso * p.trial.third_trace - 1);
    }
    return e;
  }
};

inline Mat3 rotation(const Vec3& axis, double angle) {
  const Vec3 n = unit(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3 R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = (i == j ? c : 0) + (1 - c) * n[i] * n[j];
  R(0, 1) -= s * n.z, R(1, 0) += s * n.z, R(0, 2) += s * n.y, R(2, 0) -= s * n.y, R(1, 2) -= s * n.x,
      R(2, 1) += s * n.x;
  return R;
}
inline Mat3 full(const Sym3& s) { return {{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}}; }
inline double largest(const Mat3& a) {
  double m = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m = std::fmax(m, std::fabs(a(i, j)));
  return m;
}

/// A model of one body, ready to step.
inline Model make_model(Mesh mesh, const Materials& material, const std::function<Vec3(const Vec3&)>& velocity = {},
                        std::vector<ConditionKind> conditions = {}, std::vector<LoadKind> loads = {},
                        FilterCase filter = {}, BulkViscosity viscosity = {}) {
  Elements el;
  el.blocks = make_blocks(mesh, 1);
  el.materials.push_back(material);
  State s;
  start(mesh, el, s);
  Physics ph;
  ph.elements = std::move(el);
  ph.viscosity = viscosity;
  ph.conditions = std::move(conditions);
  if (filter.kind != "off") ph.filter.emplace(filter, ph.elements, s);
  if (!loads.empty()) ph.loads.emplace(mesh, std::move(loads));
  for (auto& c : ph.conditions) std::visit([&](auto& condition) { condition.select(mesh); }, c);
  if (velocity)
    for (int n = 0; n < mesh.node_count(); ++n) s.v[NodeId(n)] = velocity(mesh.X[NodeId(n)]);
  Topology topology(mesh);
  Model m{std::move(mesh), std::move(topology), std::move(s), std::move(ph)};
  first_forces(m);
  m.physics.energy.initial = energy_row(m.physics, m.state).residual;
  return m;
}
inline Mesh box(const Vec3& lower, const Vec3& upper, std::vector<int> cells, double perturbation = 0,
                bool split = false) {
  Box b;
  b.lower = lower, b.upper = upper, b.cells = std::move(cells), b.is_split = split;
  Mesh mesh = b.make();
  if (perturbation > 0) perturb_nodes(mesh, perturbation, 7);
  return mesh;
}
inline double stable(Model& m) { return m.physics.time_step.stable(m.physics.elements, m.state); }

}  // namespace bw::csd
