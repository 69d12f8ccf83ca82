// SPDX-License-Identifier: Apache-2.0
#include "coupling/history.h"

#include <fmt/format.h>

#include "common/app/error.h"

namespace bw::coupling {

History::History(const std::string& path) : file_(path) {
  if (!file_) throw InputError(path + ": cannot be written");
  file_ << "window,t0 [s],t1 [s],substeps,area [m^2],born,dead,dry faces,dry area [m^2],"
           "impulse x [N s],impulse y [N s],impulse z [N s],impulse defect [1],moment defect [N m s],"
           "fluid work [J],solid work [J],work defect sum [J],volume gap [m^3],"
           "fluid mass [kg],fluid energy [J],covered mass [kg],uncovered mass [kg],waited [s]\n";
}

void History::write(const LedgerRow& r, double waited) {
  const double defect = r.impulse_scale > 0 ? norm(r.impulse_defect) / r.impulse_scale : 0;
  file_ << fmt::format(
      "{},{:.17g},{:.17g},{},{:.9g},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.3g},{:.3g},{:.9g},{:.9g},{:.9g},{:.9g},{:."
      "17g},"
      "{:.17g},{:.9g},{:.9g},{:.3g}\n",
      r.window, r.t0, r.t1, r.solid.substeps, r.area, r.born, r.dead, r.fluid.dry_faces, r.fluid.dry_area,
      r.solid.impulse.x, r.solid.impulse.y, r.solid.impulse.z, defect, norm(r.moment_defect), r.work_fluid,
      r.solid.work, r.work_fluid_sum - r.work_solid_sum, r.volume_gap, r.fluid.mass, r.fluid.energy,
      r.fluid.mass_covered, r.fluid.mass_uncovered, waited);
  file_.flush();  // a run that fails keeps its rows
}

}  // namespace bw::coupling
