// SPDX-License-Identifier: Apache-2.0
// What the element asks of a material. Adding one = one header + one word in list.h.
#pragma once
#include <concepts>

#include "csd/material/elastic.h"
#include "csd/material/point.h"

namespace bw::csd {

/// Isotropic materials whose Kirchhoff deviator is a multiple of dev b^e.
///   M::name            the word in the case file
///   M::components      numbers of history per point: the six of A (point.h) first, then the model's own, which start
///                      as 0
///   M::plastic         whether component 6 is eqps
///   M::points_together of plastic ones: points whose flow is solved side by side (two.h), 1, 2 or 4: more where the
///                      solution is a long chain of dependent steps
///   yields(iso, dev2, history)  of plastic ones: lanes whose trial (point.h) is beyond the yield surface
///   respond(trial, history, per_dt)  where a lane yields, the end of the step; commits the model's own history (from
///                      component 6 on) but not A. per_dt [1/s]: one over the step; 0: no time passes, nothing has a
///                      rate
///   plastic_work(history)  J/m^3 of reference volume spent since the start
///   temperature(history)   K, of plastic materials
template <class M>
concept Material = std::derived_from<M, Elastic> && requires(const M m, const Trial<double>& t, double* history) {
  { M::name } -> std::convertible_to<const char*>;
  { M::components } -> std::convertible_to<int>;
  { M::plastic } -> std::convertible_to<bool>;
  { m.respond(t, history, 0.0) } -> std::same_as<Response<double>>;
  { m.plastic_work(history) } -> std::same_as<double>;
} &&(!M::plastic || requires(const M m, const double* history) {
  { m.yields(1.0, 1.0, history) } -> std::same_as<bool>;
  { m.temperature(history) } -> std::same_as<double>;
  { m.heat.specific_heat } -> std::convertible_to<double>;
});

}  // namespace bw::csd
