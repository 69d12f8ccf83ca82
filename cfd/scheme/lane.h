// SPDX-License-Identifier: Apache-2.0
// One name for "a cell" and "Pack::size cells side by side", so that a kernel is written once for both.
#pragma once
#include "common/math/pack.h"

namespace bw::cfd {

template <class T>
struct Lane;
template <>
struct Lane<double> {
  static constexpr int width = 1;
  static double load(const double* p) { return *p; }
  static void store(double* p, double a) { *p = a; }
};
template <>
struct Lane<Pack> {
  static constexpr int width = Pack::size;
  static Pack load(const double* p) { return Pack::load(p); }
  static void store(double* p, Pack a) { a.store(p); }
};

}  // namespace bw::cfd
