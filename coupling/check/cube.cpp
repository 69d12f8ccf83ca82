// SPDX-License-Identifier: Apache-2.0
#include "coupling/check/cube.h"

#include <algorithm>

namespace bw::coupling::check {
namespace {

using Quad = std::array<int32_t, 4>;

void add_face(WetSurface& s, const Quad& quad, int32_t flags = 0) {
  const int64_t id = s.face_id.empty() ? 1000 : *std::max_element(s.face_id.begin(), s.face_id.end()) + 1;
  s.quads.push_back(quad);
  s.face_id.push_back(id);
  s.body.push_back(0);
  s.flags.push_back(flags);
}

int32_t add_node(WetSurface& s, const Vec3& x, const Vec3& v, int64_t parent) {
  const int64_t id = s.node_id.empty() ? 100 : *std::max_element(s.node_id.begin(), s.node_id.end()) + 1;
  s.x.push_back(x);
  s.v.push_back(v);
  s.node_id.push_back(id);
  s.node_parent.push_back(parent);
  return int32_t(s.x.size() - 1);
}

template <class... Lists>
void turn(Lists&... lists) {
  (std::reverse(lists.begin(), lists.end()), ...);
}

}  // namespace

WetSurface cube(const Vec3& centre, double edge) {
  WetSurface s;
  for (int k = 0; k < 2; ++k)  // node i + 3 (j + 2 k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 3; ++i) add_node(s, centre + edge * Vec3{0.5 * i - 0.5, j - 0.5, k - 0.5}, {}, -1);
  add_face(s, {0, 6, 9, 3});   // -x
  add_face(s, {2, 5, 11, 8});  // +x
  for (int32_t i = 0; i < 2; ++i) {
    add_face(s, {i, i + 1, i + 7, i + 6});       // -y
    add_face(s, {i + 3, i + 9, i + 10, i + 4});  // +y
    add_face(s, {i, i + 3, i + 4, i + 1});       // -z
    add_face(s, {i + 6, i + 7, i + 10, i + 9});  // +z
  }
  return s;
}

void split(WetSurface& s) {
  const Quad middle = {1, 4, 10, 7};  // normal +x: the lip of the left half
  int32_t copy[12];
  for (const int32_t n : middle) copy[n] = add_node(s, s.x[size_t(n)], s.v[size_t(n)], s.node_id[size_t(n)]);
  for (Quad& quad : s.quads) {
    const bool right = std::any_of(quad.begin(), quad.end(), [](int32_t n) { return n < 12 && n % 3 == 2; });
    for (int32_t& n : quad)
      if (right && n < 12 && n % 3 == 1) n = copy[n];
  }
  add_face(s, middle, face_lip);
  add_face(s, {copy[1], copy[7], copy[10], copy[4]}, face_lip);
  const int32_t last = int32_t(s.x.size()) - 1;
  turn(s.x, s.v, s.node_id, s.node_parent, s.quads, s.face_id, s.body, s.flags);
  for (Quad& quad : s.quads)
    for (int32_t& n : quad) n = last - n;
  s.topo_version += 1;
}

void degenerate(WetSurface& s) {
  const Quad side = s.quads[0];
  s.quads[0] = {side[0], side[1], side[2], side[2]};
  add_face(s, {side[0], side[2], side[3], side[3]});
  add_face(s, {0, 1, 1, 0});
  add_face(s, {5, 5, 5, 5});
  s.topo_version += 1;
}

}  // namespace bw::coupling::check
