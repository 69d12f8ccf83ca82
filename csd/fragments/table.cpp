// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "csd/element/hex.h"
#include "csd/fragments/fragments.h"
#include "csd/mesh/hex.h"

namespace bw::csd {
namespace {

/// Volume, its first and second moments about a point.
struct Moments {
  double volume = 0;
  Vec3 first;
  Mat3 second;
};
/// Of an element by 2x2x2 points: exact for parallelepipeds.
void add_moments(const std::array<NodeId, 8>& hex, const Field<Vec3, NodeId>& x, const Vec3& about, Moments& m) {
  for (int g = 0; g < 8; ++g) {
    const Vec3 at{g & 1 ? gauss : -gauss, g & 2 ? gauss : -gauss, g & 4 ? gauss : -gauss};
    Vec3 r, by[3];
    for (size_t a = 0; a < 8; ++a) {
      double N[3], dN[3];
      for (int d = 0; d < 3; ++d) N[d] = 0.5 * (1 + node_sign[a][d] * at[d]), dN[d] = 0.5 * node_sign[a][d];
      const Vec3 p = x[hex[a]] - about;
      r += N[0] * N[1] * N[2] * p;
      by[0] += dN[0] * N[1] * N[2] * p, by[1] += N[0] * dN[1] * N[2] * p, by[2] += N[0] * N[1] * dN[2] * p;
    }
    const double dV = triple(by[0], by[1], by[2]);
    m.volume += dV, m.first += dV * r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) m.second(i, j) += dV * r[i] * r[j];
  }
}

double area_of(const std::array<NodeId, 4>& quad, const Field<Vec3, NodeId>& x) {
  return 0.5 * norm(cross(x[quad[2]] - x[quad[0]], x[quad[3]] - x[quad[1]]));
}

}  // namespace

/// Eigenvalues by Jacobi's rotations.
Vec3 box_of(const Mat3& second_moments) {
  Mat3 A = second_moments;
  for (int sweep = 0; sweep < 20; ++sweep)
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (A(p, q) == 0) continue;
      const double theta = 0.5 * std::atan2(2 * A(p, q), A(p, p) - A(q, q));
      Mat3 R = Mat3::identity();
      R(p, p) = R(q, q) = std::cos(theta), R(p, q) = -std::sin(theta), R(q, p) = std::sin(theta);
      A = transpose(R) * A * R;
      A(p, q) = A(q, p) = 0;
    }
  double side[3];
  for (int d = 0; d < 3; ++d) side[d] = std::sqrt(12 * std::max(A(d, d), 0.0));
  std::sort(side, side + 3);
  return {side[2], side[1], side[0]};
}

double Fragment::shape_factor() const { return mass > 0 ? 0.25 * surface / std::cbrt(mass * mass) : 0; }

std::vector<Fragment> Fragments::table(const Mesh& mesh, const Topology& topology, const FragmentFields& in) const {
  std::vector<Fragment> rows(known_.size());
  std::vector<double> reference(rows.size(), 0.0);
  std::vector<int32_t> owner(size_t(mesh.node_count()), -1);
  for (size_t k = 0; k < rows.size(); ++k) {
    rows[k].id = known_[k].id;
    rows[k].parent = known_[k].parent;
    rows[k].birth = known_[k].birth;
  }
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    const size_t k = size_t(label_[e]);
    Fragment& row = rows[k];
    row.body = mesh.body[e];
    ++row.elements;
    row.volume += hex_volume(corners(mesh.hex[e], in.x)).volume;
    row.eqps += volume_[e] * in.eqps[size_t(i)];
    if (!in.temperature.empty()) row.temperature += volume_[e] * in.temperature[size_t(i)];
    reference[k] += volume_[e];
    if (const size_t n = size_t(mesh.hex[e][0]); n < in.is_rigid.size()) row.is_rigid = in.is_rigid[n];
    for (int side = 0; side < 6; ++side)
      if (!topology.is_bonded({e, side})) row.surface += area_of(mesh.nodes_of({e, side}), in.x);
    for (const NodeId n : mesh.hex[e]) owner[size_t(n.value)] = int32_t(k);
  }
  const auto for_nodes = [&](const auto& add) {
    for (int32_t n = 0; n < mesh.node_count(); ++n)
      if (owner[size_t(n)] >= 0) add(rows[size_t(owner[size_t(n)])], NodeId(n), size_t(owner[size_t(n)]));
  };
  for_nodes([&](Fragment& row, NodeId n, size_t) {
    row.mass += in.m[n];
    row.centroid += in.m[n] * in.x[n];
    row.velocity += in.m[n] * in.v[n];
    row.kinetic_energy += 0.5 * in.m[n] * dot(in.v[n], in.v[n]);
    for (int d = 0; d < 3; ++d) {
      row.lower[d] = std::min(row.lower[d], in.x[n][d]);
      row.upper[d] = std::max(row.upper[d], in.x[n][d]);
    }
  });
  for (size_t k = 0; k < rows.size(); ++k) {
    rows[k].centroid = rows[k].centroid / rows[k].mass;
    rows[k].velocity = rows[k].velocity / rows[k].mass;
    rows[k].eqps /= reference[k], rows[k].temperature /= reference[k];
  }
  std::vector<Mat3> inertia(rows.size());
  for_nodes([&](Fragment& row, NodeId n, size_t k) {
    const Vec3 r = in.x[n] - row.centroid;
    row.angular_momentum += in.m[n] * cross(r, in.v[n] - row.velocity);
    const double square = dot(r, r);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inertia[k](i, j) += in.m[n] * ((i == j ? square : 0.0) - r[i] * r[j]);
  });
  std::vector<Moments> moments(rows.size());
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const size_t k = size_t(label_[ElemId(i)]);
    add_moments(mesh.hex[ElemId(i)], in.x, rows[k].centroid, moments[k]);
  }
  for (size_t k = 0; k < rows.size(); ++k) {
    if (det(inertia[k]) > 0) rows[k].spin = inverse(inertia[k]) * rows[k].angular_momentum;
    const Moments& m = moments[k];
    const Vec3 mean = m.first / m.volume;
    Mat3 second = (1 / m.volume) * m.second;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) second(a, b) -= mean[a] * mean[b];
    rows[k].sides = box_of(second);
  }
  return rows;
}

}  // namespace bw::csd
