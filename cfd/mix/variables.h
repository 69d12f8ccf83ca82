// SPDX-License-Identifier: Apache-2.0
// Rows of the state, as indices into arrays of T (one cell, or a Pack of cells side by side in i).
#pragma once

namespace bw::cfd {

/// Conserved variables U as stored, [block][variable][k][j][i]; alpha1 is not conserved (d alpha/dt + v.grad alpha =
/// 0).
struct Cons {
  enum : int { arho1, arho2, mom, mom_y, mom_z, rhoE, alpha1, count };
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
    p,       ///< pressure of both materials [Pa]
    alpha1,  ///< volume fraction of material 1; exactly 0 or 1 where there is one material
    Pi,      ///< sum alpha_k (rho_k e_ref,k - p_ref,k/G_k) [Pa]
    count,
    c = count,  ///< speed of sound [m/s]
    rho_c2,     ///< rho c^2 [Pa]
    dPi,        ///< arho1 dPi/d(arho1) + arho2 dPi/d(arho2) at constant alpha [Pa]: how Pi follows a compression
    stored,
    stored_energy = stored,  ///< of a patch that burns: energy per mass of material 1 still to be released [J/kg]
    order,                   ///< of a patch with limited cells: 1, or 0 where the cell is first order
    shock,                   ///< of a patch with shocks: 1 where one crosses the cell, else 0
    rows
  };
};

}  // namespace bw::cfd
