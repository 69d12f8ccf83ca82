// SPDX-License-Identifier: Apache-2.0
#include "common/io/quantity.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string_view>
#include <vector>

#include "common/app/error.h"

namespace bw {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double foot = 0.3048, inch = 0.0254, pound = 0.45359237, g_n = 9.80665;
constexpr double pound_force = pound * g_n, gallon = 231 * inch * inch * inch;

struct Unit {
  const char* symbol;
  double si;
  int ten;  ///< one of it is si * 10^ten in SI; whole powers of ten, so that "10 us" is 1e-5 to the last bit
  Dim dim;
  bool prefixable = false;
  double offset = 0;  ///< temperatures: kelvin = si * (value + offset)
};

constexpr Dim power_dim{1, 2, -3, 0}, viscosity_dim{1, -1, -1, 0}, diffusivity_dim{0, 2, -1, 0};

constexpr Unit units[] = {
    // length, area, volume
    {"m", 1, 0, dim::length, true},
    {"in", inch, 0, dim::length},
    {"inch", inch, 0, dim::length},
    {"ft", foot, 0, dim::length},
    {"yd", 0.9144, 0, dim::length},
    {"mi", 1609.344, 0, dim::length},
    {"mil", inch, -3, dim::length},
    {"micron", 1, -6, dim::length},
    {"L", 1, -3, dim::volume, true},
    {"l", 1, -3, dim::volume, true},
    {"cc", 1, -6, dim::volume},
    {"gal", gallon, 0, dim::volume},
    // mass
    {"g", 1, -3, dim::mass, true},
    {"t", 1, 3, dim::mass},
    {"tonne", 1, 3, dim::mass},
    {"lb", pound, 0, dim::mass},
    {"lbm", pound, 0, dim::mass},
    {"oz", pound / 16, 0, dim::mass},
    {"gr", pound / 7000, 0, dim::mass},
    {"slug", pound_force / foot, 0, dim::mass},
    // time, frequency
    {"s", 1, 0, dim::time, true},
    {"sec", 1, 0, dim::time},
    {"min", 60, 0, dim::time},
    {"h", 3600, 0, dim::time},
    {"day", 86400, 0, dim::time},
    {"Hz", 1, 0, dim::frequency, true},
    {"rpm", 2 * pi / 60, 0, dim::frequency},
    // temperature
    {"K", 1, 0, dim::temperature, true},
    {"degC", 1, 0, dim::temperature, false, 273.15},
    {"degF", 5.0 / 9.0, 0, dim::temperature, false, 459.67},
    // force, pressure
    {"N", 1, 0, dim::force, true},
    {"dyn", 1, -5, dim::force, true},
    {"dyne", 1, -5, dim::force},
    {"lbf", pound_force, 0, dim::force},
    {"kgf", g_n, 0, dim::force},
    {"kip", 1e3 * pound_force, 0, dim::force},
    {"Pa", 1, 0, dim::pressure, true},
    {"bar", 1, 5, dim::pressure, true},
    {"atm", 101325, 0, dim::pressure},
    {"torr", 101325.0 / 760, 0, dim::pressure},
    {"mmHg", 133.322387415, 0, dim::pressure},
    {"psi", pound_force / (inch * inch), 0, dim::pressure},
    {"ksi", 1e3 * pound_force / (inch * inch), 0, dim::pressure},
    // energy, power
    {"J", 1, 0, dim::energy, true},
    {"erg", 1, -7, dim::energy, true},
    {"cal", 4.184, 0, dim::energy, true},
    {"eV", 1.602176634e-19, 0, dim::energy, true},
    {"BTU", 1055.05585262, 0, dim::energy},
    {"Wh", 3600, 0, dim::energy, true},
    {"W", 1, 0, power_dim, true},
    {"hp", 550 * foot * pound_force, 0, power_dim},
    // velocity, acceleration
    {"kn", 1852.0 / 3600, 0, dim::velocity},
    {"mph", 1609.344 / 3600, 0, dim::velocity},
    {"g0", g_n, 0, dim::acceleration},
    // viscosity
    {"P", 1, -1, viscosity_dim, true},
    {"St", 1, -4, diffusivity_dim, true},
    // plain numbers
    {"rad", 1, 0, dim::none, true},
    {"deg", pi / 180, 0, dim::none},
    {"rev", 2 * pi, 0, dim::none},
    {"%", 1, -2, dim::none},
};

struct Prefix {
  const char* symbol;
  int ten;
};
constexpr Prefix prefixes[] = {{"f", -15},       {"p", -12}, {"n", -9}, {"u", -6}, {"\xc2\xb5", -6},
                               {"\xce\xbc", -6}, {"m", -3},  {"c", -2}, {"d", -1}, {"h", 2},
                               {"k", 3},         {"M", 6},   {"G", 9},  {"T", 12}};

struct Named {
  Dim dim;
  const char *symbol, *name;
};
constexpr Named named[] = {
    {dim::none, "1", "a plain number"},
    {dim::length, "m", "a length"},
    {dim::mass, "kg", "a mass"},
    {dim::time, "s", "a time"},
    {dim::temperature, "K", "a temperature"},
    {dim::area, "m^2", "an area"},
    {dim::volume, "m^3", "a volume"},
    {dim::velocity, "m/s", "a velocity"},
    {dim::acceleration, "m/s^2", "an acceleration"},
    {dim::density, "kg/m^3", "a density"},
    {dim::pressure, "Pa", "a pressure"},
    {dim::force, "N", "a force"},
    {dim::energy, "J", "an energy"},
    {dim::energy_per_mass, "J/kg", "an energy per mass"},
    {dim::specific_heat, "J/(kg K)", "a specific heat"},
    {dim::frequency, "1/s", "a rate"},
    {dim::per_length, "1/m", "an inverse length"},
    {dim::stiffness, "N/m", "a stiffness"},
    {dim::specific_volume, "m^3/kg", "a specific volume"},
    {power_dim, "W", "a power"},
    {viscosity_dim, "Pa s", "a viscosity"},
    {diffusivity_dim, "m^2/s", "a diffusivity"},
};

Dim times(Dim a, Dim b, int power) {
  return {a.kg + power * b.kg, a.m + power * b.m, a.s + power * b.s, a.K + power * b.K};
}

/// Of a symbol with or without a prefix.
Unit find_unit(std::string_view symbol) {
  for (const Unit& u : units)
    if (symbol == u.symbol) return u;
  for (const Prefix& p : prefixes) {
    const std::string_view prefix = p.symbol;
    if (!symbol.starts_with(prefix)) continue;
    for (const Unit& u : units)
      if (u.prefixable && symbol.substr(prefix.size()) == u.symbol) return {u.symbol, u.si, p.ten + u.ten, u.dim};
  }
  throw InputError(fmt::format("unknown unit \"{}\" (--manual lists the units)", symbol));
}

struct Scale {
  double si = 1;
  int ten = 0;
  Dim dim;
  double offset = 0;
};

/// product := factor { [*] factor | / factor };  factor := ( symbol | 1 | "(" product ")" ) [ [^] whole number ]
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : rest_(text) {}

  Scale all() {
    const Scale s = product(0);
    if (!rest_.empty()) wrong(fmt::format("\"{}\" is not understood", rest_));
    return s;
  }

 private:
  Scale product(int depth) {
    if (depth > 20) wrong("too many parentheses");
    skip_space();
    Scale all = rest_.starts_with("/") ? Scale{} : factor(depth);  // "3 /s" is 3/s
    bool divided = false, alone = true;
    for (skip_space(); !rest_.empty() && rest_[0] != ')'; skip_space()) {
      const bool divide = take("/");
      if (!divide && (take("*") || take("\xc2\xb7"))) skip_space();
      if (!divide && divided) wrong("a product after \"/\" is ambiguous, write a/(b c)");
      divided = divided || divide;
      alone = false;
      skip_space();
      const Scale f = factor(depth);
      if (f.offset != 0) refuse_offset();
      all.si = divide ? all.si / f.si : all.si * f.si;
      all.ten += divide ? -f.ten : f.ten;
      all.dim = times(all.dim, f.dim, divide ? -1 : 1);
    }
    if (!alone && all.offset != 0) refuse_offset();
    return all;
  }

  Scale factor(int depth) {
    skip_space();
    Scale s;
    if (take("(")) {
      s = product(depth + 1);
      if (!take(")")) wrong("\")\" is missing");
    } else if (take("1")) {
      return s;
    } else {
      const Unit u = find_unit(symbol());
      s = {u.si, u.ten, u.dim, u.offset};
    }
    const int n = power();
    if (n == 1) return s;
    if (s.offset != 0) refuse_offset();
    return {std::pow(s.si, n), n * s.ten, times({}, s.dim, n), 0};
  }

  /// Letters, "%" and the micro sign; "g0" is the one symbol with a digit.
  std::string_view symbol() {
    size_t n = 0;
    if (rest_.starts_with("g0")) {
      n = 2;
    } else {
      while (n < rest_.size()) {
        const std::string_view here = rest_.substr(n);
        if (std::isalpha(static_cast<unsigned char>(here[0])) || here[0] == '%')
          n += 1;
        else if (here.starts_with("\xc2\xb5") || here.starts_with("\xce\xbc"))
          n += 2;
        else
          break;
      }
    }
    if (n == 0) wrong(rest_.empty() ? "a unit is missing" : fmt::format("\"{}\" is not understood", rest_));
    const std::string_view found = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return found;
  }

  int power() {
    if (take("\xc2\xb2")) return 2;
    if (take("\xc2\xb3")) return 3;
    const bool marked = take("^") || take("**");
    int n = 1;
    const std::string_view digits = rest_.starts_with("+") ? rest_.substr(1) : rest_;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    if (error != std::errc()) {
      if (marked) wrong("a whole power is missing after \"^\"");
      return 1;
    }
    if (std::abs(n) > 12) wrong("a power above 12");
    rest_ = digits.substr(size_t(end - digits.data()));
    return n;
  }

  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }
  void skip_space() {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\t')) rest_.remove_prefix(1);
  }
  [[noreturn]] static void wrong(const std::string& why) { throw InputError("unit: " + why); }
  [[noreturn]] static void refuse_offset() {
    throw InputError("unit: degC and degF stand alone (a temperature), write K in products and quotients");
  }

  std::string_view rest_;
};

std::string_view trimmed(std::string_view s) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
  while (!s.empty() && is_space(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_space(s.back())) s.remove_suffix(1);
  return s;
}

const Named* find_named(Dim dim) {
  for (const Named& n : named)
    if (n.dim == dim) return &n;
  return nullptr;
}

}  // namespace

Quantity read_quantity(const std::string& text) {
  std::string_view s = trimmed(text);
  if (s.starts_with("+")) s.remove_prefix(1);
  double value = 0;
  const std::string_view first = s.starts_with("-") ? s.substr(1) : s;  // from_chars would also read "inf" and "nan"
  const bool is_number = !first.empty() && (std::isdigit(static_cast<unsigned char>(first[0])) || first[0] == '.');
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (!is_number || error == std::errc::invalid_argument) throw InputError("no number at its beginning");
  if (error != std::errc()) throw InputError("a number out of range");
  const std::string_view unit = trimmed(s.substr(size_t(end - s.data())));
  if (unit.empty()) return {value, dim::none, false};
  const Scale scale = UnitParser(unit).all();
  const double power = std::pow(10.0, std::abs(scale.ten));  // exact to 10^22
  const double base = scale.si * (value + scale.offset), si = scale.ten < 0 ? base / power : base * power;
  if (!std::isfinite(si)) throw InputError("a number out of range");
  return {si, scale.dim, true};
}

double parse_quantity(const std::string& text, Dim expected) {
  const auto wrong = [&](const std::string& why) {
    return InputError(fmt::format("expected {}, got \"{}\": {}", dimension_name(expected), text, why));
  };
  Quantity q;
  try {
    q = read_quantity(text);
  } catch (const InputError& e) {
    throw wrong(e.what());
  }
  if (!q.has_unit && expected != dim::none) throw wrong("a unit is missing (a number without quotes is SI)");
  if (q.dim != expected) throw wrong(dimension_name(q.dim));
  return q.value;
}

std::string si_symbol(Dim dim) {
  if (const Named* n = find_named(dim)) return n->symbol;
  const std::pair<const char*, int> parts[] = {{"kg", dim.kg}, {"m", dim.m}, {"s", dim.s}, {"K", dim.K}};
  std::string above, below;
  int count_below = 0;
  for (const auto& [symbol, n] : parts) {
    if (n == 0) continue;
    std::string& side = n > 0 ? above : below;
    if (!side.empty()) side += ' ';
    side += std::abs(n) == 1 ? std::string(symbol) : fmt::format("{}^{}", symbol, std::abs(n));
    if (n < 0) ++count_below;
  }
  if (above.empty()) above.push_back('1');
  if (below.empty()) return above;
  return count_below == 1 ? fmt::format("{}/{}", above, below) : fmt::format("{}/({})", above, below);
}

std::string dimension_name(Dim dim) {
  const Named* n = find_named(dim);
  if (n && dim == dim::none) return n->name;
  return n ? fmt::format("{} ({})", n->name, n->symbol) : fmt::format("a quantity in {}", si_symbol(dim));
}

std::string unit_manual() {
  std::string out;
  Dim last{99, 0, 0, 0};
  for (const Unit& u : units) {
    if (u.dim != last) {
      const Named* n = find_named(u.dim);
      out += fmt::format("{}- {}:", out.empty() ? "" : "\n",
                         u.dim == dim::none ? "plain numbers" : n->name + (n->name[1] == 'n' ? 3 : 2));
    }
    out += fmt::format(" {}{}", u.symbol, u.prefixable ? "*" : "");
    last = u.dim;
  }
  return out + "\n\nUnits marked * take the prefixes f p n u m c d h k M G T (mm, us, GPa, kbar).\n";
}

}  // namespace bw
