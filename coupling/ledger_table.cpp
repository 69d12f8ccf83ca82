// SPDX-License-Identifier: Apache-2.0
#include "coupling/ledger_table.h"

namespace bw::coupling {

namespace {

std::vector<History::Column> columns() {
  return {{"t", "s"},
          {"window", "1"},
          {"dt", "s"},
          {"substeps", "1"},
          {"area", "m^2"},
          {"born_faces", "1"},
          {"dead_faces", "1"},
          {"dry_faces", "1"},
          {"dry_area", "m^2"},
          {"impulse_x", "N s"},
          {"impulse_y", "N s"},
          {"impulse_z", "N s"},
          {"advance_x", "N s"},
          {"advance_y", "N s"},
          {"advance_z", "N s"},
          {"impulse_defect", "1"},
          {"moment_defect", "N m s"},
          {"fluid_work", "J"},
          {"solid_work", "J"},
          {"fluid_work_sum", "J"},
          {"solid_work_sum", "J"},
          {"volume_gap", "m^3"},
          {"added_mass", "1"},
          {"fluid_mass", "kg"},
          {"fluid_energy", "J"},
          {"fluid_momentum_x", "kg m/s"},
          {"fluid_momentum_y", "kg m/s"},
          {"fluid_momentum_z", "kg m/s"},
          {"mass_covered", "kg"},
          {"mass_uncovered", "kg"},
          {"energy_covered", "J"},
          {"energy_uncovered", "J"},
          {"waited", "s"}};
}

}  // namespace

History open_ledger_table(const std::string& path) { return History(path, columns()); }

History resume_ledger_table(const std::string& path, int64_t rows) {
  return History::resume_rows(path, columns(), rows);
}

void write_row(History& table, const LedgerRow& r, double waited) {
  const FluidTotals& f = r.fluid;
  const Vec3 &impulse = r.solid.impulse, &momentum = f.momentum;
  table.row({r.t1,
             double(r.window),
             r.t1 - r.t0,
             double(r.solid.substeps),
             r.area,
             double(r.born),
             double(r.dead),
             double(f.dry_faces),
             f.dry_area,
             impulse.x,
             impulse.y,
             impulse.z,
             r.advance.x,
             r.advance.y,
             r.advance.z,
             r.impulse_scale > 0 ? norm(r.impulse_defect) / r.impulse_scale : 0,
             norm(r.moment_defect),
             r.work_fluid,
             r.solid.work,
             r.work_fluid_sum,
             r.work_solid_sum,
             r.volume_gap,
             r.added_mass,
             f.mass,
             f.energy,
             momentum.x,
             momentum.y,
             momentum.z,
             f.mass_covered,
             f.mass_uncovered,
             f.energy_covered,
             f.energy_uncovered,
             waited});
}

}  // namespace bw::coupling
