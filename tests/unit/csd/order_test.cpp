// SPDX-License-Identifier: Apache-2.0
// The order of elements: a permutation, by body, in bricks where the mesh allows it, never worse than the curve.
#include "csd/mesh/order.h"

#include <numeric>

#include "csd/mesh/cylinder.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

std::vector<ElemId> all_of(const Mesh& mesh) {
  std::vector<ElemId> elems;
  for (int e = 0; e < mesh.elem_count(); ++e) elems.push_back(ElemId(e));
  return elems;
}
double nodes_a_block(const Mesh& mesh, const std::vector<ElemId>& order) {
  return double(nodes_of_blocks(mesh, order)) * lanes / double(order.size());
}
bool is_permutation(std::vector<ElemId> order, const Mesh& mesh) {
  std::sort(order.begin(), order.end());
  return order == all_of(mesh);
}
/// The same elements in an order without sense.
Mesh shuffled(const Mesh& mesh, uint64_t seed) {
  std::vector<ElemId> order = all_of(mesh);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[size_t(uniform01(seed, i) * double(i))]);
  Mesh m = mesh;
  for (size_t i = 0; i < order.size(); ++i) m.hex[ElemId(i)] = mesh.hex[order[i]], m.elem_gid[ElemId(i)] = order[i];
  return m;
}
Mesh taylor_bar() {
  Cylinder c;
  c.radius = 3.2e-3, c.length = 32.4e-3, c.across = 8, c.along = 20;
  return c.make();
}

TEST(Order, BlocksAreBricksWhereTheMeshIsEven) {
  for (const Mesh& mesh : {box({0, 0, 0}, {3, 1, 1}, {36, 12, 12}), taylor_bar()}) {
    const std::vector<ElemId> order = element_order(mesh);
    EXPECT_TRUE(is_permutation(order, mesh));
    EXPECT_DOUBLE_EQ(nodes_a_block(mesh, order), 27);  // 3 x 3 x 3
    EXPECT_GT(nodes_a_block(mesh, hilbert_order(mesh, all_of(mesh))), 30);
  }
}

TEST(Order, IsNeverWorseThanTheCurve) {
  const std::vector<Mesh> meshes{box({0, 0, 0}, {1.5, 1.3, 1.1}, {15, 13, 11}), box({0, 0, 0}, {1, 1, 1}, {1, 1, 37}),
                                 box({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, 0, true),
                                 shuffled(box({0, 0, 0}, {3, 1, 1}, {18, 6, 6}), 5),
                                 box({0, 0, 0}, {1, 1, 1}, {1, 2, 3})};
  for (const Mesh& mesh : meshes) {
    const std::vector<ElemId> elems = all_of(mesh), order = element_order(mesh);
    EXPECT_TRUE(is_permutation(order, mesh));
    EXPECT_TRUE(is_permutation(brick_order(mesh, pair_faces(mesh), elems), mesh));
    EXPECT_LE(nodes_of_blocks(mesh, order), nodes_of_blocks(mesh, hilbert_order(mesh, elems)));
    EXPECT_EQ(order, element_order(mesh));
  }
  EXPECT_LT(nodes_a_block(meshes[0], element_order(meshes[0])), 28.5);  // odd sides: what is left over is packed
  EXPECT_LT(nodes_a_block(meshes[2], element_order(meshes[2])), 24);    // of tetrahedra
}

TEST(Order, BodiesAreNotMixed) {
  Mesh two = box({0, 0, 0}, {1, 1, 1}, {5, 3, 3});
  for (int e = 0; e < two.elem_count(); e += 2) two.body[ElemId(e)] = 1;
  const std::vector<ElemId> order = element_order(two);
  EXPECT_TRUE(is_permutation(order, two));
  for (size_t i = 1; i < order.size(); ++i) EXPECT_LE(two.body[order[i - 1]], two.body[order[i]]);
}

}  // namespace
}  // namespace bw::csd
