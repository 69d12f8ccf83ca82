// SPDX-License-Identifier: Apache-2.0
#include "csd/mesh/order.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "common/data/csr.h"
#include "common/math/pack.h"

namespace bw::csd {
namespace {

/// Distance along a Hilbert curve of 2^21 cells a side [Skilling 2004].
uint64_t hilbert_key(uint32_t x, uint32_t y, uint32_t z) {
  constexpr int bits = 21;
  uint32_t X[3] = {x, y, z};
  for (uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {  // inverse undo
    const uint32_t p = q - 1;
    for (auto& Xi : X) {
      if (Xi & q) {
        X[0] ^= p;
      } else {
        const uint32_t t = (X[0] ^ Xi) & p;
        X[0] ^= t, Xi ^= t;
      }
    }
  }
  X[1] ^= X[0], X[2] ^= X[1];  // Gray encode
  uint32_t t = 0;
  for (uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    if (X[2] & q) t ^= q - 1;
  for (auto& Xi : X) Xi ^= t;
  uint64_t key = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (uint32_t Xi : X) key = key << 1 | (Xi >> b & 1);
  return key;
}

/// Indices of the points along the curve through the cube around them.
std::vector<int32_t> along_curve(const std::vector<Vec3>& points) {
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3& x : points)
    for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
  const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  std::vector<uint64_t> key;
  for (const Vec3& x : points) {
    const Vec3 r = (2097151.0 / size) * (x - low);
    key.push_back(hilbert_key(uint32_t(r.x), uint32_t(r.y), uint32_t(r.z)));
  }
  std::vector<int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int32_t a, int32_t b) { return key[size_t(a)] < key[size_t(b)]; });
  return order;
}

/// Mean of the elements' centroids.
template <class Elems>
Vec3 centre(const Mesh& mesh, const Elems& elems) {
  Vec3 sum;
  for (const ElemId e : elems)
    for (const NodeId n : mesh.hex[e]) sum += mesh.X[n];
  return (0.125 / double(elems.size())) * sum;
}

/// Places in a list of elements, divided into groups.
struct Groups {
  std::vector<int32_t> of;  ///< [place] group
  int32_t count = 0;

  Csr<int32_t> members() const {
    return Csr<int32_t>::build(count, [&](auto&& add) {
      for (size_t i = 0; i < of.size(); ++i) add(of[i], int32_t(i));
    });
  }
};

/// Joins each group with that neighbour, among those still alone, with which it shares the most faces; of several the
/// largest, then the first. neighbours: [place] places over the faces.
Groups join_in_pairs(const Groups& g, const Csr<int32_t>& neighbours) {
  const auto near = Csr<int32_t>::build(g.count, [&](auto&& add) {  // a neighbour once for each face
    for (size_t i = 0; i < g.of.size(); ++i)
      for (const int32_t j : neighbours[int64_t(i)])
        if (g.of[size_t(j)] != g.of[i]) add(g.of[i], g.of[size_t(j)]);
  });
  std::vector<int32_t> size(size_t(g.count), 0), joined(size_t(g.count), -1);
  for (const int32_t group : g.of) ++size[size_t(group)];
  Groups next{std::vector<int32_t>(g.of.size())};
  std::vector<int32_t> list;
  for (int32_t a = 0; a < g.count; ++a) {
    if (joined[size_t(a)] >= 0) continue;
    list.assign(near[a].begin(), near[a].end());
    std::sort(list.begin(), list.end());
    int32_t best = -1;
    std::pair<size_t, int32_t> most{0, 0};  // faces, size
    for (size_t first = 0, last; first < list.size(); first = last) {
      const int32_t b = list[first];
      for (last = first; last < list.size() && list[last] == b;) ++last;
      if (joined[size_t(b)] >= 0) continue;
      if (const std::pair value{last - first, size[size_t(b)]}; value > most) most = value, best = b;
    }
    joined[size_t(a)] = next.count;
    if (best >= 0) joined[size_t(best)] = next.count;
    ++next.count;
  }
  for (size_t i = 0; i < g.of.size(); ++i) next.of[i] = joined[size_t(g.of[i])];
  return next;
}

/// Groups of at most `lanes` places that share faces.
Groups grow_bricks(const Mesh& mesh, const FacePartners& partner, const std::vector<ElemId>& elems) {
  std::vector<int32_t> place(size_t(mesh.elem_count()), -1);
  for (size_t i = 0; i < elems.size(); ++i) place[size_t(elems[i])] = int32_t(i);
  const auto neighbours = Csr<int32_t>::build(int64_t(elems.size()), [&](auto&& add) {
    for (size_t i = 0; i < elems.size(); ++i)
      for (const int32_t code : partner[elems[i]])
        if (const Face f = face_of(code); f.elem.valid() && place[size_t(f.elem)] >= 0)
          add(int64_t(i), place[size_t(f.elem)]);
  });
  Groups g{std::vector<int32_t>(elems.size()), int32_t(elems.size())};
  std::iota(g.of.begin(), g.of.end(), 0);
  for (int size = 1; size < lanes; size *= 2) g = join_in_pairs(g, neighbours);
  return g;
}

}  // namespace

std::vector<ElemId> hilbert_order(const Mesh& mesh, const std::vector<ElemId>& elems) {
  std::vector<Vec3> centres;
  for (const ElemId e : elems) centres.push_back(centre(mesh, std::array{e}));
  std::vector<ElemId> order;
  for (const int32_t i : along_curve(centres)) order.push_back(elems[size_t(i)]);
  return order;
}

std::vector<ElemId> brick_order(const Mesh& mesh, const FacePartners& partner, const std::vector<ElemId>& elems) {
  const Csr<int32_t> groups = grow_bricks(mesh, partner, elems).members();
  std::vector<ElemId> packed;  // whole bricks, then the rest along the curve
  std::vector<std::vector<ElemId>> rest;
  for (int64_t g = 0; g < groups.rows(); ++g) {
    std::vector<ElemId> members;
    for (const int32_t i : groups[g]) members.push_back(elems[size_t(i)]);
    if (int(members.size()) == lanes)
      packed.insert(packed.end(), members.begin(), members.end());
    else
      rest.push_back(std::move(members));
  }
  std::vector<Vec3> centres;
  for (const auto& members : rest) centres.push_back(centre(mesh, members));
  for (const int32_t i : along_curve(centres))
    packed.insert(packed.end(), rest[size_t(i)].begin(), rest[size_t(i)].end());
  const auto block = [&](int32_t b) { return std::span(packed).subspan(size_t(b) * lanes, lanes); };
  centres.clear();
  for (int32_t b = 0; b < int32_t(packed.size() / lanes); ++b) centres.push_back(centre(mesh, block(b)));
  std::vector<ElemId> order;
  for (const int32_t b : along_curve(centres)) order.insert(order.end(), block(b).begin(), block(b).end());
  order.insert(order.end(), packed.begin() + std::ptrdiff_t(order.size()), packed.end());  // the block that is not full
  return order;
}

int64_t nodes_of_blocks(const Mesh& mesh, const std::vector<ElemId>& order) {
  int64_t sum = 0;
  std::vector<NodeId> nodes;
  for (size_t first = 0; first < order.size(); first += lanes) {
    nodes.clear();
    for (size_t i = first; i < std::min(first + lanes, order.size()); ++i)
      nodes.insert(nodes.end(), mesh.hex[order[i]].begin(), mesh.hex[order[i]].end());
    std::sort(nodes.begin(), nodes.end());
    sum += std::unique(nodes.begin(), nodes.end()) - nodes.begin();
  }
  return sum;
}

std::vector<ElemId> element_order(const Mesh& mesh) {
  std::vector<std::vector<ElemId>> bodies;
  for (int e = 0; e < mesh.elem_count(); ++e) {
    const size_t body = size_t(mesh.body[ElemId(e)]);
    if (body >= bodies.size()) bodies.resize(body + 1);
    bodies[body].push_back(ElemId(e));
  }
  const FacePartners partner = pair_faces(mesh);
  std::vector<ElemId> order;
  for (const auto& elems : bodies) {
    const std::vector<ElemId> curve = hilbert_order(mesh, elems), bricks = brick_order(mesh, partner, elems);
    const auto& best = nodes_of_blocks(mesh, bricks) <= nodes_of_blocks(mesh, curve) ? bricks : curve;
    order.insert(order.end(), best.begin(), best.end());
  }
  return order;
}

}  // namespace bw::csd
