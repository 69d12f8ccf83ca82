// SPDX-License-Identifier: Apache-2.0
// Rows of the state, as indices into arrays of T (one cell, or a Pack of cells side by side in i). Materials count from
// k = 0. Of one or two materials there are the first rows alone; of more, all volume fractions are rows, also that of
// k = 1: what is absent is exactly 0, and no material is another one's remainder.
#pragma once

namespace bw::cfd {

/// Most materials in one run: kernels are compiled for each number.
inline constexpr int most_materials = 6;

/// Conserved variables U as stored, [block][variable][k][j][i]; alpha is not conserved (d alpha/dt + v.grad alpha =
/// 0).
struct Cons {
  enum : int { arho1, arho2, mom, mom_y, mom_z, rhoE, alpha1, count, most = 4 + 2 * most_materials };
  static constexpr int rows(int materials) { return materials <= 2 ? int(count) : 4 + 2 * materials; }
  static constexpr int arho(int k) { return k < 2 ? k : 4 + 2 * k; }
  /// Of two materials, only k = 0.
  static constexpr int alpha(int k) { return k == 0 ? int(alpha1) : k == 1 ? int(count) : 5 + 2 * k; }
  static constexpr bool is_alpha(int q) { return q == alpha1 || q == count || (q > count && q % 2 == 1); }
};

/// Primitive variables W of a patch. The first `count` are reconstructed at faces; c, rho_c2 and dPi belong to cell
/// centres.
struct Prim {
  enum : int {
    arho1,  ///< alpha1 rho1 [kg/m^3]
    arho2,  ///< alpha2 rho2 [kg/m^3]
    v,      ///< velocity, three rows [m/s]
    v_y,
    v_z,
    p,       ///< pressure of all materials [Pa]
    alpha1,  ///< volume fraction of material 1; exactly 0 or 1 where there is one material
    Pi,      ///< sum alpha_k (rho_k e_ref,k - p_ref,k/G_k) [Pa]
    count,
    c = count,  ///< speed of sound [m/s]
    rho_c2,     ///< rho c^2 [Pa]
    dPi,        ///< sum arho_k dPi/d(arho_k) at constant alpha [Pa]: how Pi follows a compression
    stored,
    stored_energy = stored,  ///< of a patch that burns: energy per mass of material 1 still to be released [J/kg]
    order,                   ///< of a patch with limited cells: 1, or 0 where the cell is first order
    shock,                   ///< of a patch with shocks: 1 where one crosses the cell, else 0; beside walls: cfd/scheme/carbuncle.h
    two_rows,                ///< rows of one or two materials
    most = 11 + 3 * most_materials
  };
  /// Rows of a patch of more than two materials, and of a cell W.
  static constexpr int rows(int materials) { return materials <= 2 ? int(two_rows) : 11 + 3 * materials; }
  static constexpr int arho(int k) { return k < 2 ? k : 11 + 3 * k; }
  static constexpr int alpha(int k) { return k == 0 ? int(alpha1) : k == 1 ? int(two_rows) : 12 + 3 * k; }
  /// Material k's part of Pi; reconstructed apart, that materials can be limited apart.
  static constexpr int part(int k) { return k < 2 ? two_rows + 1 + k : 13 + 3 * k; }
  /// Where the volume fraction stands that is row q of Cons.
  static constexpr int alpha_of(int q) { return q == Cons::alpha1 ? int(alpha1) : q == Cons::count ? alpha(1) : alpha((q - 5) / 2); }
};
/// Rows of a state at a face: those of Prim that are reconstructed, side by side.
struct FaceRow {
  static constexpr int rows(int materials) { return materials <= 2 ? int(Prim::count) : 5 + 2 * materials; }
  static constexpr int arho(int k) { return k < 2 ? k : 5 + 2 * k; }
  static constexpr int alpha(int k) { return k == 0 ? int(Prim::alpha1) : k == 1 ? int(Prim::count) : 6 + 2 * k; }
  /// The row of Prim.
  static constexpr int prim(int q) {
    return q < Prim::count ? q : q == Prim::count ? Prim::alpha(1) : q % 2 ? Prim::arho((q - 5) / 2) : Prim::alpha((q - 6) / 2);
  }
};
static_assert(Cons::rows(most_materials) == Cons::most && Prim::rows(most_materials) == Prim::most);

}  // namespace bw::cfd
