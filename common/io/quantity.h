// SPDX-License-Identifier: Apache-2.0
// Numbers with units: "7.76 g/cm^3", "1.283e10 dyn/cm^2", "150 us", "25 degC", "4.29e6 J/kg", "kg/(m s^2)".
// A unit is a product or quotient of symbols with whole powers and parentheses; `a/b c` is refused as ambiguous.
#pragma once
#include <string>

#include "common/math/units.h"

namespace bw {

/// A number and its unit, in SI. `has_unit` is false for "3".
struct Quantity {
  double value = 0;
  Dim dim;
  bool has_unit = false;
};
/// Throws InputError without place when the text is no finite number with a known unit.
Quantity read_quantity(const std::string& text);

/// "1.283e10 dyn/cm^2" -> 1.283e9 for dim::pressure. Throws InputError without place when the text or the dimension is
/// wrong.
double parse_quantity(const std::string& text, Dim expected);

/// The SI symbol of a dimension: Pa, m/s, kg/m^3, J/(kg K), ...; "1" for a plain number.
std::string si_symbol(Dim dim);

/// "a pressure (Pa)", "a plain number": for messages.
std::string dimension_name(Dim dim);

/// Every unit with its meaning, for the manual.
std::string unit_manual();

}  // namespace bw
