// SPDX-License-Identifier: Apache-2.0
// A lane of a pack does what the scalar kernel does, bit for bit. Compiled without contraction to fused multiply-adds:
// which product of a sum the compiler fuses is its choice, per instance of a template.
#pragma GCC optimize("fp-contract=off")
#include <gtest/gtest.h>

#include "solid_scene.h"

namespace bw::csd {
namespace {

template <class T, class M>
[[gnu::flatten, gnu::noinline]] ElementForce<T> forces(const M& material, const Corners<T>& x, T V0, double* history) {
  return internal_force<T>(material, x, V0, history, [&](T J) { return material.volumetric.mean_stress(J); });
}

TEST(A3, PackEqualsScalarBitByBit) {
  const auto material = copper_j2();
  constexpr int stride = 8 * J2<LinearFlow>::components * lanes;
  Aligned<double> packed(stride, 0.0);
  std::vector<OneElement<J2<LinearFlow>>> single;
  for (int l = 0; l < Pack::size; ++l) {
    single.emplace_back(material, random_hex(uint64_t(l), 0.1));
    for (int i = 0; i < stride / lanes; ++i) packed[size_t(i * lanes + l)] = single.back().history[size_t(i * lanes)];
  }
  for (int n = 1; n <= 10; ++n) {
    Corners<Pack> x;
    Pack V0;
    std::vector<ElementForce<double>> expected;
    for (int l = 0; l < Pack::size; ++l) {
      const Corners<double> one =
          shaken(single[size_t(l)].X, uint64_t(50 + l), 0.01 * n * (l == 0 ? 0.01 : 1));  // one lane stays elastic
      for (int a = 0; a < 8; ++a) x.a[a].x.set(l, one.a[a].x), x.a[a].y.set(l, one.a[a].y), x.a[a].z.set(l, one.a[a].z);
      V0.set(l, single[size_t(l)].V0);
      expected.push_back(forces<double>(material, one, single[size_t(l)].V0, single[size_t(l)].history.data()));
    }
    const auto r = forces<Pack>(material, x, V0, packed.data());
    for (int l = 0; l < Pack::size; ++l) {
      for (int a = 0; a < 8; ++a) {
        EXPECT_EQ(r.f.a[a].x[l], expected[size_t(l)].f.a[a].x);
        EXPECT_EQ(r.f.a[a].y[l], expected[size_t(l)].f.a[a].y);
        EXPECT_EQ(r.f.a[a].z[l], expected[size_t(l)].f.a[a].z);
      }
      for (int i = 0; i < stride / lanes; ++i)
        EXPECT_EQ(packed[size_t(i * lanes + l)], single[size_t(l)].history[size_t(i * lanes)]);
    }
  }
}

}  // namespace
}  // namespace bw::csd
