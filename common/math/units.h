// SPDX-License-Identifier: Apache-2.0
// SI dimensions of input quantities, named in the describe() of every model.
#pragma once

namespace bw {

/// Exponents of kg, m, s, K.
struct Dim {
  int kg = 0, m = 0, s = 0, K = 0;
  friend bool operator==(const Dim&, const Dim&) = default;
};

namespace dim {
inline constexpr Dim none{}, length{0, 1, 0, 0}, mass{1, 0, 0, 0}, time{0, 0, 1, 0}, temperature{0, 0, 0, 1}, area{0, 2, 0, 0},
    volume{0, 3, 0, 0}, velocity{0, 1, -1, 0}, acceleration{0, 1, -2, 0}, density{1, -3, 0, 0}, pressure{1, -1, -2, 0}, force{1, 1, -2, 0},
    energy{1, 2, -2, 0}, energy_per_mass{0, 2, -2, 0}, specific_heat{0, 2, -2, -1}, frequency{0, 0, -1, 0}, per_length{0, -1, 0, 0},
    stiffness{1, 0, -2, 0}, spin{0, 0, -1, 0}, specific_volume{-1, 3, 0, 0};
}  // namespace dim

}  // namespace bw
