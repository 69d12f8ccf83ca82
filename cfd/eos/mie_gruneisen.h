// SPDX-License-Identifier: Apache-2.0
// Every equation of state here has the Mie-Grueneisen form with a constant Gruneisen coefficient G and covolume b,
//   p = p_ref(rho) + G rho (e - e_ref(rho))/(1 - b rho),
// so that a mixture in pressure equilibrium has p = (rho e - Pi)/sum(alpha (1 - b rho)/G) without iteration [Shyue
// 2001, Allaire 2002]. A model gives only its constants and its reference curve; the algebra below is the only copy.
#pragma once
#include <concepts>

#include "common/math/pack.h"

namespace bw::cfd {

/// The reference curve at one density.
template <class T>
struct Reference {
  T p;        ///< p_ref [Pa]
  T e;        ///< e_ref [J/kg]
  T rho_dp;   ///< rho dp_ref/drho [Pa]
  T rho2_de;  ///< rho^2 de_ref/drho [Pa]
};

/// Densities and pressures between which a model is meant to be used (the property tests sample them).
struct EosRange {
  double rho_min, rho_max;  ///< kg/m^3
  double p_min, p_max;      ///< Pa
};

/// A model: one header in cfd/eos and one word in cfd/eos/list.h.
template <class M>
concept Eos = requires(M m, double rho) {
  { M::name } -> std::convertible_to<const char*>;
  { M::constant_reference } -> std::convertible_to<bool>;  // p_ref constant, e_ref zero
  { m.Gruneisen() } -> std::convertible_to<double>;
  { m.covolume() } -> std::convertible_to<double>;  // of a constant reference only
  { m.reference(rho) } -> std::same_as<Reference<double>>;
  { m.range() } -> std::same_as<EosRange>;
};

/// The Gruneisen coefficient at a density.
template <Eos M, class T>
T gruneisen(const M& m, T rho) {
  return m.Gruneisen() / (T(1) - m.covolume() * rho);
}
template <Eos M, class T>
T pressure(const M& m, T rho, T e) {
  const Reference<T> r = m.reference(rho);
  return r.p + gruneisen(m, rho) * rho * (e - r.e);
}
/// e(rho, p) [J/kg], the inverse of pressure().
template <Eos M, class T>
T internal_energy(const M& m, T rho, T p) {
  const Reference<T> r = m.reference(rho);
  return r.e + (p - r.p) / (gruneisen(m, rho) * rho);
}
/// rho c^2 = rho dp/drho|_e + (p/rho) dp/de|_rho [Pa]
template <Eos M, class T>
T bulk_stiffness(const M& m, T rho, T p) {
  const Reference<T> r = m.reference(rho);
  const T free = T(1) - m.covolume() * rho, G = m.Gruneisen() / free;
  return r.rho_dp + (p - r.p) / free + G * (p - r.rho2_de);
}
template <Eos M, class T>
T sound_speed(const M& m, T rho, T p) {
  return sqrt(bulk_stiffness(m, rho, p) / rho);
}

/// What one material adds to the mixture's closure at its own density rho.
template <class T>
struct PiTerms {
  T pi;         ///< rho e_ref - p_ref/G [Pa]; Pi = sum alpha pi
  T dpi;        ///< dpi/drho [J/kg]
  T stiffness;  ///< (rho c^2 - (G + 1) p)/G [Pa]: the part of the stiffness that does not depend on p
};
template <Eos M, class T>
PiTerms<T> pi_terms(const M& m, T rho) {
  const Reference<T> r = m.reference(rho);
  const double over_G = 1 / m.Gruneisen();
  return {rho * r.e - r.p * over_G, r.e + (r.rho2_de - r.rho_dp * over_G) / rho, (r.rho_dp - r.p) * over_G - r.rho2_de};
}

}  // namespace bw::cfd
