// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/app/error.h"
#include "csd/mesh/faces.h"
#include "csd/mesh/hex.h"
#include "csd/mesh/topology.h"

namespace bw::csd {

namespace {

std::string place(const Vec3& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", p.x, p.y, p.z); }

std::string element(const Mesh& mesh, ElemId e) {
  return fmt::format("element {} at {}", mesh.elem_gid[e], place(centroid(corners(mesh.hex[e], mesh.X))));
}

// by nodes alone, so that the geometry may be looked at afterwards
void check_connectivity(const Mesh& mesh, const std::string& where) {
  if (mesh.elem_count() == 0) throw InputError(where + ": the mesh has no elements");
  std::vector<char> is_used(size_t(mesh.node_count()), 0);
  std::vector<std::pair<std::array<int32_t, 8>, int32_t>> sorted;
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    std::array<int32_t, 8> nodes;
    for (size_t a = 0; a < 8; ++a) {
      nodes[a] = mesh.hex[e][a];
      if (nodes[a] < 0 || nodes[a] >= mesh.node_count())
        throw InputError(
            fmt::format("{}: element {} uses node {}, which does not exist", where, mesh.elem_gid[e], nodes[a]));
      is_used[size_t(nodes[a])] = 1;
    }
    std::sort(nodes.begin(), nodes.end());
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end())
      throw InputError(
          fmt::format("{}: {} uses a node twice (degenerate hexahedra are not supported)", where, element(mesh, e)));
    sorted.push_back({nodes, i});
  }
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first)
      throw InputError(fmt::format("{}: {} has the same nodes as element {} (duplicate)", where,
                                   element(mesh, ElemId(sorted[i].second)),
                                   mesh.elem_gid[ElemId(sorted[i - 1].second)]));
  const auto free = std::find(is_used.begin(), is_used.end(), 0);
  if (free != is_used.end()) {
    const NodeId n(free - is_used.begin());
    throw InputError(fmt::format("{}: node {} at {} belongs to no element", where, mesh.node_gid[n], place(mesh.X[n])));
  }
}

bool has_no_hinge(const Mesh& mesh, const Topology& topology, NodeId& hinge) {
  for (int32_t n = 0; n < mesh.node_count(); ++n)
    if (topology.star_parts(mesh, NodeId(n)) > 1) {
      hinge = NodeId(n);
      return false;
    }
  return true;
}

int count_pieces(const Mesh& mesh) {
  std::vector<int32_t> root(size_t(mesh.node_count()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int32_t n) {
    while (root[size_t(n)] != n) n = root[size_t(n)] = root[size_t(root[size_t(n)])];
    return n;
  };
  int pieces = mesh.node_count();
  for (const auto& h : mesh.hex)
    for (size_t a = 1; a < 8; ++a) {
      const int32_t p = find(h[0]), q = find(h[a]);
      if (p == q) continue;
      root[size_t(std::max(p, q))] = std::min(p, q);
      --pieces;
    }
  return pieces;
}

}  // namespace

int valid_node_order(const HexCorners& c) {
  if (hex_volume(c).min_jacobian > 0) return 0;
  for (int k = 1; k < 4; ++k) {
    HexCorners trial;
    for (size_t a = 0; a < 8; ++a) trial[a] = c[size_t(known_node_order[k][a])];
    if (scaled_jacobian(trial) > 0) return k;
  }
  return -1;
}

int mend_node_order(Mesh& mesh, const std::string& where) {
  int mended = 0;
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    const HexCorners c = corners(mesh.hex[e], mesh.X);
    const int order = valid_node_order(c);
    if (order < 0) {
      const HexVolume v = hex_volume(c);
      throw InputError(fmt::format(
          "{}: {} is inverted: volume {:.6g} m^3, smallest Jacobian {:.6g} m^3, in no known node order valid", where,
          element(mesh, e), v.volume, v.min_jacobian));
    }
    if (order == 0) continue;
    ++mended;
    const auto given = mesh.hex[e];
    for (size_t a = 0; a < 8; ++a) mesh.hex[e][a] = given[size_t(known_node_order[order][a])];
  }
  return mended;
}

MeshQuality check_mesh(Mesh& mesh, const std::string& where, bool may_have_pieces) {
  check_connectivity(mesh, where);
  for (int32_t n = 0; n < mesh.node_count(); ++n)
    if (const Vec3 p = mesh.X[NodeId(n)]; !std::isfinite(p.x + p.y + p.z))
      throw InputError(fmt::format("{}: the position of node {} is not a number", where, mesh.node_gid[NodeId(n)]));
  MeshQuality quality;
  quality.mended = mend_node_order(mesh, where);
  if (quality.mended > 0)
    quality.notes.push_back(
        fmt::format("{}: node order of {} elements was wrong and has been mended", where, quality.mended));
  quality.nodes = mesh.node_count();
  quality.elements = mesh.elem_count();
  std::vector<double> scaled;
  quality.min_edge = 1e300;
  for (const auto& hex : mesh.hex) {
    const HexCorners c = corners(hex, mesh.X);
    scaled.push_back(scaled_jacobian(c));
    quality.volume += hex_volume(c).volume;
    for (const auto& edge : hex_edge) {
      const double length = norm(c[size_t(edge[1])] - c[size_t(edge[0])]);
      quality.min_edge = std::min(quality.min_edge, length);
      quality.max_edge = std::max(quality.max_edge, length);
    }
  }
  quality.poor = int(std::count_if(scaled.begin(), scaled.end(), [](double s) { return s < 0.2; }));
  std::vector<int32_t> order(scaled.size());
  std::iota(order.begin(), order.end(), 0);
  const auto five = order.begin() + long(std::min<size_t>(5, order.size()));
  std::partial_sort(order.begin(), five, order.end(), [&](int32_t a, int32_t b) {
    return std::pair(scaled[size_t(a)], a) < std::pair(scaled[size_t(b)], b);
  });
  for (auto e = order.begin(); e != five; ++e)
    if (const double s = scaled[size_t(*e)]; s < 0.5)
      quality.worst.push_back({mesh.elem_gid[ElemId(*e)], s, centroid(corners(mesh.hex[ElemId(*e)], mesh.X))});
  for (const double s : scaled) quality.histogram[size_t(std::clamp(int(10 * s), 0, 9))] += 1;
  quality.min_scaled_jacobian = *std::min_element(scaled.begin(), scaled.end());
  std::nth_element(scaled.begin(), scaled.begin() + long(scaled.size() / 2), scaled.end());
  quality.median_scaled_jacobian = scaled[scaled.size() / 2];
  if (quality.min_scaled_jacobian <= 0)
    quality.notes.push_back(where + ": an element has an inverted corner (its integration points are valid)");
  if (NodeId hinge; !has_no_hinge(mesh, Topology(mesh, where), hinge))
    throw InputError(fmt::format("{}: node {} at {} joins elements that share no face there (a hinge)", where,
                                 mesh.node_gid[hinge], place(mesh.X[hinge])));
  quality.pieces = count_pieces(mesh);
  if (quality.pieces > 1 && !may_have_pieces)
    throw InputError(fmt::format(
        "{}: the mesh falls into {} unconnected pieces (coincident nodes not merged?); pieces = true allows it", where,
        quality.pieces));
  if (const auto inner = mesh.face_sets.find("inner"); inner != mesh.face_sets.end() && !inner->second.empty())
    if (is_closed(mesh, inner->second)) quality.cavity_volume = -sum_faces(mesh, mesh.X, inner->second).volume;
  return quality;
}

std::string summary(const MeshQuality& q) {
  std::string text = fmt::format(
      "{} elements, {} nodes, {:.6g} m^3, edges {:.4g} to {:.4g} m, scaled Jacobian {:.3f} at least, {:.3f} median, {} "
      "below 0.2",
      q.elements, q.nodes, q.volume, q.min_edge, q.max_edge, q.min_scaled_jacobian, q.median_scaled_jacobian, q.poor);
  if (q.pieces > 1) text += fmt::format(", {} pieces", q.pieces);
  if (q.cavity_volume > 0) text += fmt::format(", cavity {:.6g} m^3", q.cavity_volume);
  return text;
}

std::vector<std::string> quality_report(const MeshQuality& q) {
  std::vector<std::string> lines;
  if (q.min_scaled_jacobian >= 0.9) return lines;
  std::string bins;
  for (size_t b = 0; b < q.histogram.size(); ++b)
    if (q.histogram[b] > 0)
      bins += fmt::format("{}to {:.1f}: {}", bins.empty() ? "" : ", ", 0.1 * double(b + 1), q.histogram[b]);
  lines.push_back("elements by scaled Jacobian: " + bins);
  for (const auto& w : q.worst)
    lines.push_back(fmt::format("scaled Jacobian {:.3f}: element {} at {}", w.scaled_jacobian, w.gid, place(w.centre)));
  return lines;
}

}  // namespace bw::csd
