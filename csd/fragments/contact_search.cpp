// SPDX-License-Identifier: Apache-2.0
// Which nodes may meet which faces within the next steps.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "common/parallel/loop.h"
#include "csd/fragments/contact.h"
#include "csd/mesh/hex.h"
#include "csd/model.h"

namespace bw::csd {
namespace {

struct Box {
  Vec3 lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  void add(const Vec3& x) {
    for (int d = 0; d < 3; ++d) lower[d] = std::min(lower[d], x[d]), upper[d] = std::max(upper[d], x[d]);
  }
  bool has(const Vec3& x) const {
    return x.x >= lower.x && x.x <= upper.x && x.y >= lower.y && x.y <= upper.y && x.z >= lower.z && x.z <= upper.z;
  }
  Box grown(double margin) const {
    return {lower - Vec3{margin, margin, margin}, upper + Vec3{margin, margin, margin}};
  }
};
bool overlap(const Box& a, const Box& b) {
  bool all = true;
  for (int d = 0; d < 3; ++d) all = all && a.lower[d] <= b.upper[d] && b.lower[d] <= a.upper[d];
  return all;
}
Box box_of(const Model& m, Face f) {
  Box box;
  for (const NodeId n : m.mesh.nodes_of(f)) box.add(m.state.x[n]);
  return box;
}

/// Boxes by the cells of a grid that they touch; cells share buckets.
class Grid {
 public:
  Grid(const std::vector<Box>& boxes, double cell) : cell_(cell) {
    size_t size = 16;
    while (size < 2 * boxes.size()) size *= 2;
    start_.assign(size + 1, 0);
    const auto for_cells = [&](const Box& box, const auto& visit) {
      const auto a = cell_of(box.lower), b = cell_of(box.upper);
      for (int64_t i = a[0]; i <= b[0]; ++i)
        for (int64_t j = a[1]; j <= b[1]; ++j)
          for (int64_t k = a[2]; k <= b[2]; ++k) visit(bucket({i, j, k}));
    };
    for (const Box& box : boxes) for_cells(box, [&](size_t b) { ++start_[b + 1]; });
    for (size_t b = 0; b < size; ++b) start_[b + 1] += start_[b];
    items_.resize(size_t(start_.back()));
    std::vector<int32_t> next(start_.begin(), start_.end() - 1);
    for (size_t i = 0; i < boxes.size(); ++i)
      for_cells(boxes[i], [&](size_t b) { items_[size_t(next[b]++)] = int32_t(i); });
  }
  /// Boxes that may be at x, some twice.
  std::span<const int32_t> at(const Vec3& x) const {
    const size_t b = bucket(cell_of(x));
    return {items_.data() + start_[b], size_t(start_[b + 1] - start_[b])};
  }

 private:
  std::array<int64_t, 3> cell_of(const Vec3& x) const {
    return {int64_t(std::floor(x.x / cell_)), int64_t(std::floor(x.y / cell_)), int64_t(std::floor(x.z / cell_))};
  }
  size_t bucket(const std::array<int64_t, 3>& c) const {  // hash of [Teschner et al. 2003]
    return (uint64_t(c[0]) * 73856093u ^ uint64_t(c[1]) * 19349663u ^ uint64_t(c[2]) * 83492791u) & (start_.size() - 2);
  }
  double cell_;
  std::vector<int32_t> start_, items_;
};

/// Of each side: a part of the smaller of the face's size and of the element's extent behind it, in the reference
/// configuration.
std::array<float, 6> depths_of(const Mesh& mesh, ElemId e) {
  const double volume = hex_volume(corners(mesh.hex[e], mesh.X)).volume;
  std::array<float, 6> depths{};
  for (int side = 0; side < 6; ++side) {
    const auto q = mesh.nodes_of({e, side});
    const double area = 0.5 * norm(cross(mesh.X[q[2]] - mesh.X[q[0]], mesh.X[q[3]] - mesh.X[q[1]]));
    if (area > 0) depths[size_t(side)] = float(0.25 * std::min(volume / area, std::sqrt(area)));
  }
  return depths;
}

std::vector<NodeId> nodes_of_faces(const Model& m, const std::vector<Face>& faces) {
  std::vector<NodeId> nodes;
  for (const Face f : faces)
    for (const NodeId n : m.mesh.nodes_of(f)) nodes.push_back(n);
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

void Contact::find_depths(const Mesh& mesh) {
  if (depths_.size() > 0) return;
  depths_.resize(size_t(mesh.elem_count()));
  parallel_for(mesh.elem_count(), [&](int64_t e) { depths_[ElemId(e)] = depths_of(mesh, ElemId(e)); });
}

void Contact::follow_surface(Model& m) {
  const auto& ranks = m.physics.elements.ranks;
  if (!ranks || m.state.followed.empty()) return;
  std::vector<char> is_wanted(size_t(m.mesh.node_count()), 0);
  const auto& boundary = m.topology.boundary();
  for (const NodeId n : nodes_of_faces(m, input_.bodies ? boundary : fresh_)) is_wanted[size_t(n)] = 1;
  ranks->complete(m.state);
  ranks->follow_also(is_wanted, m.state);
}

void Contact::add_lips(const Model& m) {
  if (!input_.lips) return;
  const auto& boundary = m.topology.boundary();
  is_fresh_.resize(size_t(m.mesh.elem_count()), 0);
  for (lips_ = std::max(lips_, size_t(m.topology.original_boundary_count())); lips_ < boundary.size(); ++lips_) {
    const Face lip = boundary[lips_];
    fresh_.push_back(lip);
    is_fresh_[lip.elem] = uint8_t(is_fresh_[lip.elem] | 1 << lip.side);
  }
}

/// Each node of a lip against the face on the other side, unless that has it, too; no more once they have moved apart.
void Contact::search_lips(const Model& m) {
  const auto& x = m.state.x;
  const auto centre = [&](Face f) {
    Vec3 c;
    for (const NodeId n : m.mesh.nodes_of(f)) c += 0.25 * x[n];
    return c;
  };
  std::erase_if(fresh_, [&](Face lip) {
    const auto q = m.mesh.nodes_of(lip);
    const double size = 0.5 * (norm(x[q[2]] - x[q[0]]) + norm(x[q[3]] - x[q[1]]));
    const bool is_parted = norm(centre(lip) - centre(m.topology.partner(lip))) > 0.5 * size;
    if (is_parted) is_fresh_[lip.elem] = uint8_t(is_fresh_[lip.elem] & ~(1 << lip.side));
    return is_parted;
  });
  near_lips_.clear();
  for (const Face lip : fresh_) {
    const Face partner = m.topology.partner(lip);
    const auto theirs = m.mesh.nodes_of(partner);
    const float depth = depths_[partner.elem][size_t(partner.side)];
    for (const NodeId n : m.mesh.nodes_of(lip)) {
      if (std::find(theirs.begin(), theirs.end(), n) != theirs.end()) continue;
      near_lips_.pairs.push_back({n, partner, depth});
      near_lips_.group.push_back(int32_t(near_lips_.pairs.size()));
    }
  }
}

/// Whether search_lips has it.
bool Contact::is_lip_pair(const Model& m, NodeId n, Face f) const {
  if (f.elem >= int32_t(is_fresh_.size())) return false;
  const Face partner = m.topology.partner(f);
  if (!partner.elem.valid() || !(is_fresh_[partner.elem] >> partner.side & 1)) return false;
  const auto nodes = m.mesh.nodes_of(partner);
  return std::find(nodes.begin(), nodes.end(), n) != nodes.end();
}

/// Faces in the box, with the margin, of another component. With many components all faces: they are close to some.
std::vector<Face> Contact::faces_near_others(const Model& m, const Fragments& fragments) const {
  const auto& boundary = m.topology.boundary();
  if (fragments.count() > 64) return boundary;
  std::vector<Box> boxes(size_t(fragments.count()));
  for (const Face f : boundary)
    for (const NodeId n : m.mesh.nodes_of(f)) boxes[size_t(fragments.label()[f.elem])].add(m.state.x[n]);
  std::vector<Face> faces;
  for (const Face f : boundary) {
    const size_t own = size_t(fragments.label()[f.elem]);
    const Box box = box_of(m, f).grown(margin_);
    for (size_t k = 0; k < boxes.size(); ++k)
      if (k != own && overlap(box, boxes[k])) {
        faces.push_back(f);
        break;
      }
  }
  return faces;
}

/// travel: by which two things come nearer in a step, at most.
void Contact::search_bodies(Model& m, double travel) {
  if (!m.physics.cracks && !own_fragments_) own_fragments_.emplace(m.mesh, m.state.t);
  const Fragments& fragments = m.physics.cracks ? m.physics.cracks->fragments(m) : *own_fragments_;
  const auto& x = m.state.x;
  surface_ = nodes_of_faces(m, m.topology.boundary());
  drift_ = {};
  for (const NodeId n : surface_) drift_ += (1.0 / double(surface_.size())) * m.state.v[n];
  near_bodies_.clear();
  used_ = travel;
  margin_ = 4 * travel;
  double size = 0;
  for (const Face f : m.topology.boundary()) {
    const Box box = box_of(m, f);
    size += norm(box.upper - box.lower) / double(m.topology.boundary().size());
  }
  margin_ = std::max(margin_, 0.25 * size);
  const std::vector<Face> faces = faces_near_others(m, fragments);
  if (faces.empty()) return;
  std::vector<Box> boxes(faces.size());
  parallel_for(int64_t(faces.size()),
               [&](int64_t i) { boxes[size_t(i)] = box_of(m, faces[size_t(i)]).grown(margin_); });
  double mean = 0, longest = 0;
  for (const Box& box : boxes) {
    const double length = norm(box.upper - box.lower);
    mean += length / double(boxes.size()), longest = std::max(longest, length);
  }
  const Grid grid(boxes, std::max(mean, 0.125 * longest));
  const std::vector<NodeId> nodes = nodes_of_faces(m, faces);
  std::vector<int32_t> label_of(faces.size());
  for (size_t i = 0; i < faces.size(); ++i) label_of[i] = fragments.label()[faces[i].elem];
  constexpr int64_t chunk = 512;
  std::vector<Nearby> parts((nodes.size() + chunk - 1) / chunk);
  parallel_for_dynamic(int64_t(parts.size()), [&](int64_t p) {
    Nearby& part = parts[size_t(p)];
    std::vector<std::pair<int32_t, int32_t>> here;  // (component, face)
    for (size_t i = size_t(p * chunk); i < std::min(nodes.size(), size_t((p + 1) * chunk)); ++i) {
      const NodeId n = nodes[i];
      const int32_t own = fragments.label()[m.topology.elements(n)[0]];
      here.clear();
      for (const int32_t k : grid.at(x[n]))
        if (const int32_t label = label_of[size_t(k)]; label != own && boxes[size_t(k)].has(x[n]))
          if (!is_lip_pair(m, n, faces[size_t(k)])) here.push_back({label, k});
      std::sort(here.begin(), here.end());
      here.erase(std::unique(here.begin(), here.end()), here.end());
      for (size_t k = 0; k < here.size(); ++k) {
        const size_t face = size_t(here[k].second);
        part.pairs.push_back({n, faces[face], depths_[faces[face].elem][size_t(faces[face].side)]});
        if (k + 1 == here.size() || here[k].first != here[k + 1].first)
          part.group.push_back(int32_t(part.pairs.size()));
      }
    }
  });
  for (const Nearby& part : parts) {
    const int32_t offset = int32_t(near_bodies_.pairs.size());
    near_bodies_.pairs.insert(near_bodies_.pairs.end(), part.pairs.begin(), part.pairs.end());
    for (size_t g = 1; g < part.group.size(); ++g) near_bodies_.group.push_back(offset + part.group[g]);
  }
}

}  // namespace bw::csd
