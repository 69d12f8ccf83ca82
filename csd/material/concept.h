// SPDX-License-Identifier: Apache-2.0
// What the element asks of a material. Adding one = one header + one word in list.h.
#pragma once
#include <concepts>

#include "csd/material/elastic.h"
#include "csd/material/point.h"

namespace bw::csd {

/// Isotropic materials whose Kirchhoff deviator is a multiple of dev b^e.
///   M::name            the word in the case file
///   M::components      numbers of history per point: the six of A (point.h) first, then the model's own
///   M::plastic         whether component 6 is eqps
///   respond(trial, history)  end of the step; commits the model's own history (from component 6 on) but not A
///   plastic_work(eqps) J/m^3 of reference volume spent since the start
template <class M>
concept Material = std::derived_from<M, Elastic> &&
    requires(const M m, const Trial<double>& t, double* history, double eqps) {
  { M::name } -> std::convertible_to<const char*>;
  { M::components } -> std::convertible_to<int>;
  { M::plastic } -> std::convertible_to<bool>;
  { m.respond(t, history) } -> std::same_as<Response<double>>;
  { m.plastic_work(eqps) } -> std::same_as<double>;
};

}  // namespace bw::csd
