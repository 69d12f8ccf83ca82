// SPDX-License-Identifier: Apache-2.0
#include "common/io/quantity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/app/error.h"

using namespace bw;

TEST(Quantity, reads_numbers_with_units) {
  const struct {
    const char* text;
    Dim dim;
    double si;
  } cases[] = {
      {"7.76 g/cm^3", dim::density, 7760},
      {"1.283e10 dyn/cm^2", dim::pressure, 1.283e9},
      {"150 us", dim::time, 150e-6},
      {"150us", dim::time, 150e-6},
      {"150 \xc2\xb5s", dim::time, 150e-6},
      {"150 \xce\xbcs", dim::time, 150e-6},
      {"25 degC", dim::temperature, 298.15},
      {"77 degF", dim::temperature, 298.15},
      {"0.5 km/s", dim::velocity, 500},
      {"10 bar", dim::pressure, 1e6},
      {"371.213 GPa", dim::pressure, 3.71213e11},
      {"1 Mbar", dim::pressure, 1e11},
      {"1 psi", dim::pressure, 6894.757293168361},
      {"1 ksi", dim::pressure, 6894757.293168361},
      {"1 atm", dim::pressure, 101325},
      {"3 kg/(m s^2)", dim::pressure, 3},
      {"3 kg m^-1 s^-2", dim::pressure, 3},
      {"3 kg*m^-1*s^-2", dim::pressure, 3},
      {"3 N/m2", dim::pressure, 3},
      {"3 N/m\xc2\xb2", dim::pressure, 3},
      {"3 N/m**2", dim::pressure, 3},
      {"4.29e6 J/kg", dim::energy_per_mass, 4.29e6},
      {"4.29 kJ/g", dim::energy_per_mass, 4.29e6},
      {"4.29e10 erg/g", dim::energy_per_mass, 4.29e6},
      {"450 J/(kg K)", dim::specific_heat, 450},
      {"450 J/kg/K", dim::specific_heat, 450},
      {"1/s", dim::frequency, 1},
      {"3 kHz", dim::frequency, 3000},
      {"60 rpm", dim::spin, 2 * M_PI},
      {"3 /s", dim::frequency, 3},
      {"3 1/s", dim::frequency, 3},
      {"2/(m s)", {0, -1, -1, 0}, 2},
      {"3 s^-1", dim::frequency, 3},
      {"-3 mm", dim::length, -3e-3},
      {"+3 mm", dim::length, 3e-3},
      {".5 in", dim::length, 0.0127},
      {"2 ft", dim::length, 0.6096},
      {"3 min", dim::time, 180},
      {"1 lb", dim::mass, 0.45359237},
      {"2 (m/s)^2", dim::energy_per_mass, 2},
      {"1 L", dim::volume, 1e-3},
      {"1 cm^3/g", dim::specific_volume, 1e-3},
      {"2 g0", dim::acceleration, 19.6133},
      {"180 deg", dim::none, M_PI},
      {"5 %", dim::none, 0.05},
      {"5 mm/m", dim::none, 0.005},
      {"3", dim::none, 3},
      {"  3 m  ", dim::length, 3},
  };
  for (const auto& c : cases) {
    try {
      EXPECT_NEAR(parse_quantity(c.text, c.dim), c.si, 1e-12 * std::abs(c.si)) << c.text;
    } catch (const InputError& e) {
      ADD_FAILURE() << c.text << ": " << e.what();
    }
  }
}

TEST(Quantity, powers_of_ten_are_exact) {
  EXPECT_EQ(parse_quantity("10 us", dim::time), 10e-6);
  EXPECT_EQ(parse_quantity("7.76 g/cm^3", dim::density), 7760);
  EXPECT_EQ(parse_quantity("1.283e10 dyn/cm^2", dim::pressure), 1.283e9);
  EXPECT_EQ(parse_quantity("0.7 km/s", dim::velocity), 700);
  EXPECT_EQ(parse_quantity("1.3 mm", dim::length), 1.3e-3);
}

TEST(Quantity, refuses_what_it_does_not_understand) {
  const struct {
    const char* text;
    const char* why;
  } cases[] = {
      {"", "no number"},
      {"abc", "no number"},
      {"nan", "no number"},
      {"-inf s", "no number"},
      {"1e400 s", "out of range"},
      {"1e308 km", "out of range"},
      {"3", "a unit is missing"},
      {"3 parsec", "unknown unit \"parsec\""},
      {"3 kpsi", "unknown unit \"kpsi\""},
      {"3 kg/m s", "ambiguous"},
      {"3 kg/m*s", "ambiguous"},
      {"3 (m", "\")\" is missing"},
      {"3 m)", "not understood"},
      {"3 m/", "a unit is missing"},
      {"3 m^", "a whole power is missing"},
      {"3 m^99", "a power above 12"},
      {"3 m^1.5", "not understood"},
      {"3 degC/m", "stand alone"},
      {"3 J/degC", "stand alone"},
      {"3 degC^2", "stand alone"},
      {"3 m 4", "not understood"},
      {"3 m", "a length (m)"},
      {"3 kg/s^5", "a quantity in kg/s^5"},
  };
  for (const auto& c : cases) {
    try {
      ADD_FAILURE() << c.text << " read as " << parse_quantity(c.text, dim::time);
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(c.why), std::string::npos) << c.text << ": " << e.what();
      EXPECT_EQ(std::string(e.what()).find("expected a time (s), got \""), 0u) << e.what();
    }
  }
  EXPECT_THROW(parse_quantity("3 " + std::string(1000, '('), dim::time), InputError);
}

TEST(Quantity, names_dimensions) {
  EXPECT_EQ(si_symbol(dim::pressure), "Pa");
  EXPECT_EQ(si_symbol(dim::none), "1");
  EXPECT_EQ(si_symbol({1, 0, -5, 0}), "kg/s^5");
  EXPECT_EQ(si_symbol({-1, 0, 0, -2}), "1/(kg K^2)");
  EXPECT_EQ(dimension_name(dim::density), "a density (kg/m^3)");
  EXPECT_NE(unit_manual().find("- pressure: Pa* bar* atm"), std::string::npos) << unit_manual();
}
