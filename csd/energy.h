// SPDX-License-Identifier: Apache-2.0
// The books of energy (VALIDATION S12): what went in, where it is, and what is missing.
#pragma once
#include "common/math/units.h"
#include "csd/state.h"

namespace bw::csd {

class Rigid;
struct Physics;

/// [solid.energy]
struct EnergyCase {
  double warn = 0.01, stop = 0;
  template <class K>
  void describe(K& k) {
    k.optional(
        "warn", warn, dim::none,
        "a warning, and where it arises, when the residual exceeds this fraction of the energy at hand; 0: none");
    k.optional("stop", stop, dim::none, "the run ends (exit code 3) when it exceeds this fraction; 0: never");
    k.expect(warn >= 0, "warn", "a number >= 0");
    k.expect(stop >= 0, "stop", "a number >= 0");
  }
};

/// What only flows, summed over the steps [J].
struct EnergyBooks {
  double external = 0;      ///< work of the loads
  double viscosity = 0;     ///< spent in bulk viscosity
  double cracks = 0;        ///< set free by cracks
  double left = 0;          ///< kinetic, of fragments that left the box
  double rigidization = 0;  ///< of inner motion, lost when bodies became rigid
  double initial = 0;       ///< kinetic and stored at the start
};

/// All terms at one time [J]; conditions and mass_scaling came in from outside; residual = kinetic + stored + spent -
/// initial - brought in.
struct EnergyRow {
  double kinetic = 0, elastic = 0, plastic = 0, filter = 0, collapse = 0, viscosity = 0, external = 0, conditions = 0,
         cracks = 0, rigidization = 0, left = 0, mass_scaling = 0, residual = 0;
  double heat = 0;                               ///< part of plastic
  double contact = 0, springs = 0, damping = 0;  ///< of which conditions: rigid walls and contact, springs, drag
  double eqps_max = 0;                           ///< of all integration points
  double temperature_max = 0;                    ///< K, of all points; 0: no material has a temperature
};

/// Nodes of rigid bodies count with their bodies, and may be elsewhere (Rigid::complete).
double kinetic_energy(const State& s, const Rigid* rigid = nullptr);
/// Product form v^(n-1/2) . v^(n+1/2) m/2: what central differences conserve; differs from kinetic_energy by dt^2/8
/// f^2/m, dt of the node. short_dt: the shortest of the local steps.
double kinetic_product(const State& s, double short_dt, const Rigid* rigid = nullptr);
/// kg m/s; likewise.
Vec3 momentum_of(const State& s, const Rigid* rigid);
/// Forces out of balance over loads and reactions (roots of sums of squares), of a run to static; 1 before the first
/// step.
double static_imbalance(const Physics& ph);
EnergyRow energy_row(const Physics& ph, const State& s);

}  // namespace bw::csd
