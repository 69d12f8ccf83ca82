// SPDX-License-Identifier: Apache-2.0
// VALIDATION T11: everything breaks.
#include <gtest/gtest.h>

#include <omp.h>
#include <ctime>

#include "common/math/random.h"
#include "csd/fracture/fracture.h"
#include "csd/mesh/box.h"
#include "csd/mesh/hex.h"
#include "csd/mesh/shell.h"
#include "solid_scene.h"

namespace bw::csd {
namespace {

double total_volume(const Mesh& m, const std::vector<Vec3>& x) {
  double sum = 0;
  for (const auto& h : m.hex) {
    HexCorners c;
    for (size_t a = 0; a < 8; ++a) c[a] = x[size_t(h[a].value)];
    sum += hex_volume(c).volume;
  }
  return sum;
}

struct Storm {
  Mesh mesh;
  int64_t events = 0;
  double seconds = 0;
};
// a rough state: every element failed by a different amount, each in a tension of its own, which turns from step to
// step
Storm storm(Mesh mesh, int steps, bool is_checked) {
  Storm s{std::move(mesh)};
  Mesh& m = s.mesh;
  Topology t(m);
  Fracture fracture({}, m);
  std::vector<Vec3> x(m.X.begin(), m.X.end());
  const double volume = total_volume(m, x);
  const size_t elems = size_t(m.elem_count());
  std::vector<double> fail(elems);
  std::vector<Sym3> sigma(elems);
  for (int step = 0; step < steps; ++step) {
    for (size_t e = 0; e < elems; ++e) {
      const auto r = [&](uint64_t k) { return uniform01(5, e, uint64_t(step) * 8 + k); };
      fail[e] = 0.8 + r(0);
      const Vec3 n = unit({r(1) - 0.5, r(2) - 0.5, r(3) - 0.5});
      sigma[e] = {1e9 * n.x * n.x, 1e9 * n.y * n.y, 1e9 * n.z * n.z, 1e9 * n.x * n.y, 1e9 * n.x * n.z, 1e9 * n.y * n.z};
    }
    std::vector<NodeSplit> splits;
    std::vector<ElemId> changed;
    const std::clock_t start = std::clock();
    fracture.advance(
        m, t, x, [&](ElemId e) { return sigma[size_t(e.value)]; }, fail, splits, changed);
    s.seconds += double(std::clock() - start) / CLOCKS_PER_SEC;
    for (const NodeSplit& split : splits) {
      EXPECT_EQ(size_t(split.child.value), x.size());
      x.push_back(x[size_t(split.parent.value)]);
    }
    if (is_checked) {
      EXPECT_EQ(t.find_fault(m), "");
      EXPECT_EQ(total_volume(m, x), volume);
    }
  }
  EXPECT_EQ(t.find_fault(m), "");
  EXPECT_LE(m.node_count(), 8 * m.elem_count());
  s.events = fracture.opened();
  return s;
}

Mesh box(int n) {
  Box b;
  b.cells = {n, n, n};
  return b.make();
}

TEST(FractureStorm, MassAndTopologySurvive) {
  const Storm s = storm(box(8), 12, true);
  std::printf("%d elements, %d nodes, %ld faces opened\n", s.mesh.elem_count(), s.mesh.node_count(), long(s.events));
  EXPECT_GT(s.mesh.node_count(), 7 * s.mesh.elem_count());  // nearly all loose
  Weapon weapon;
  weapon.around = 24;
  storm(weapon.make(), 4, true);
}

TEST(FractureStorm, TetSplitMeshesToo) {
  Box b;
  b.cells = {2, 2, 2};
  b.is_split = true;
  const Storm s = storm(b.make(), 12, true);
  EXPECT_GT(s.mesh.node_count(), 6 * s.mesh.elem_count());
}

TEST(FractureStorm, CostPerEventDoesNotGrowWithTheMesh) {
  double first = 0, last = 0;  // time of the processor: other programs' load is not counted
  for (const int n : {8, 16, 32, 47}) {
    const Storm s = storm(box(n), 3, false);
    last = s.seconds / double(s.events);
    if (n == 8) first = last;
    std::printf("%6d elements: %7ld faces opened, %.2f us each\n", n * n * n, long(s.events), 1e6 * last);
  }
  record("cpu_us_per_face_of_103823_over_512_elements", last / first);
  EXPECT_LT(last, 4 * first);  // memory beyond the caches, but no work that grows with the mesh
}

TEST(FractureStorm, DoesNotDependOnThreads) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Storm one = storm(box(12), 3, false);
  omp_set_num_threads(3);
  const Storm three = storm(box(12), 3, false);
  omp_set_num_threads(threads);
  ASSERT_EQ(one.mesh.node_count(), three.mesh.node_count());
  for (int e = 0; e < one.mesh.elem_count(); ++e) ASSERT_EQ(one.mesh.hex[ElemId(e)], three.mesh.hex[ElemId(e)]);
}

}  // namespace
}  // namespace bw::csd
